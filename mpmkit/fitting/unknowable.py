"""What cannot be known from the measurements, in plain words."""

from __future__ import annotations

import numpy as np

from .profiles import Interval
from .solve import MISSED, Solution
from .words import Names, length

BOUND_TOGETHER = 0.95
"""Correlation of two parameters from which on they are not told apart."""
DOMINANT = 2.0
"""Part of the uncertainty of a row below which it counts as not depending on a parameter."""


def correlation(solution: Solution) -> np.ndarray:
    """Of the parameters, along their scales, ``(n, n)``."""
    covariance = solution.survey.likelihood.covariance(solution.survey.best)
    width = np.sqrt(np.diag(covariance))
    return covariance / np.outer(width, width)


def sentences(solution: Solution, names: Names) -> list[str]:
    """What cannot be known, and what does not fit."""
    said = []
    for index, interval in enumerate(solution.survey.intervals):
        if not solution.survey.bounded[index]:
            said.append(_open(solution, names, index, interval))
    said += _bound_together(solution, names)
    said += _missed(solution)
    return said


def _open(solution: Solution, names: Names, index: int, interval: Interval) -> str:
    path = solution.coordinates.paths[index]
    name = names.name(path)
    low, high = (solution.coordinates.value(index, u) for u in (interval.low, interval.high))
    flat = _flat(solution, index, interval)
    from_prior = not (interval.low_open or interval.high_open)
    if flat:
        depends = "do not depend" if len(flat) > 1 else "does not depend"
        prior = " What is said of it comes from its prior alone." if from_prior else ""
        return f"The {' and the '.join(flat)} {depends} on the {name} {names.said(path, low, high)}.{prior}"
    if from_prior or (interval.low_open and interval.high_open):
        return (
            f"The {name} cannot be known from these measurements: any value {names.said(path, low, high)} "
            "fits them, since another parameter makes up for it."
        )
    end, known = (high, "at most") if interval.low_open else (low, "at least")
    bound = "lower" if interval.low_open else "upper"
    return (
        f"Of the {name} these measurements only say that it is {known} {names.said(path, end)}: the "
        f"{bound} bound of the search fits as well."
    )


def _flat(solution: Solution, index: int, interval: Interval) -> list[str]:
    """The measured quantities that change by less than their uncertainty along a parameter alone."""
    along = np.repeat(solution.survey.best[None], 21, axis=0)
    along[:, index] = np.linspace(interval.low, interval.high, 21)
    rows = solution.survey.likelihood.surrogate(along)
    change = np.ptp(rows, axis=0) / solution.survey.likelihood.misfit.total
    found, start = [], 0
    for test in solution.runs.tests:
        for one in test.measured:
            part = change[start : start + len(one.value)]
            start += len(one.value)
            if part.max() < DOMINANT:
                found.append(one.quantity.words)
    every = sum(len(test.measured) for test in solution.runs.tests)
    return list(dict.fromkeys(found)) if len(found) == every else []


def _bound_together(solution: Solution, names: Names) -> list[str]:
    said, r = [], correlation(solution)
    paths = solution.coordinates.paths
    for i in range(len(paths)):
        for j in range(i):
            if abs(r[i, j]) >= BOUND_TOGETHER:
                way = "more" if r[i, j] > 0 else "less"
                said.append(
                    f"The {names.name(paths[j])} and the {names.name(paths[i])} are hard to tell apart "
                    f"(correlation {r[i, j]:.2f}): more of the one and {way} of the other fit almost as well."
                )
    return said


def _missed(solution: Solution) -> list[str]:
    said = []
    survey = solution.survey
    if survey.widened > 1:
        said.append(
            f"The misfit is {np.sqrt(survey.widened):.2g} times what the uncertainties explain, so that the "
            "intervals were widened by that: the model lacks something, or the uncertainties are larger."
        )
    start, total = 0, survey.likelihood.misfit.total
    for test in solution.runs.tests:
        for one in test.measured:
            row = start
            start += len(one.value)
            off = (solution.fitted[row] - one.value[0]) / total[row]
            if not one.is_curve and abs(off) > MISSED:
                unit = one.quantity.unit
                said.append(
                    f"The {one.quantity.words} of test '{test.name}' is missed: measured "
                    f"{length(one.value[0], unit)}, fitted {length(solution.fitted[row], unit)}."
                )
    if not survey.agrees:
        said.append(
            "At the ends of the intervals runs do not quite say what the polynomial through them says: "
            "take the intervals as rough."
        )
    return said
