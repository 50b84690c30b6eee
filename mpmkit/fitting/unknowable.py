"""Sentences about parameters that the measurements do not determine."""

from __future__ import annotations

import numpy as np

from .profiles import Interval
from .solve import MISSED, Solution
from .words import Names, length

BOUND_TOGETHER = 0.95
"""Above this correlation, two parameters cannot be distinguished."""
PLACES = 61
"""Places along a parameter at which its influence is checked."""
WIDE = 0.3
"""If the parameter has no influence over more than this part of its interval, the sentence says so."""


def correlation(solution: Solution) -> np.ndarray:
    """Correlation of the parameters, along their scales, ``(n, n)``."""
    covariance = solution.survey.likelihood.covariance(solution.survey.best)
    width = np.sqrt(np.diag(covariance))
    return covariance / np.outer(width, width)


def sentences(solution: Solution, names: Names) -> list[str]:
    """Sentences about parameters that are not determined, and that cannot be distinguished."""
    said = []
    for index, interval in enumerate(solution.survey.intervals):
        if not solution.survey.bounded[index]:
            said.append(_open(solution, names, index, interval))
    return said + _bound_together(solution, names)


def _open(solution: Solution, names: Names, index: int, interval: Interval) -> str:
    path = solution.coordinates.paths[index]
    name = names.name(path)
    low, high = (solution.coordinates.value(index, u) for u in (interval.low, interval.high))
    flat, flat_low, flat_high = _flat(solution, index, interval)
    from_prior = not (interval.low_open or interval.high_open)
    if flat:
        depends = "do not depend" if len(flat) > 1 else "does not depend"
        prior = " Its interval comes only from its prior." if from_prior else ""
        between = names.said(path, flat_low, flat_high)
        return f"The {' and the '.join(flat)} {depends} on the {name} {between}.{prior}"
    if from_prior or (interval.low_open and interval.high_open):
        return (
            f"These measurements do not determine the {name}: any value {names.said(path, low, high)} fits "
            "them, because another parameter compensates for it."
        )
    end, known = (high, "at most") if interval.low_open else (low, "at least")
    bound = "lower" if interval.low_open else "upper"
    return (
        f"These measurements only show that the {name} is {known} {names.said(path, end)}: the "
        f"{bound} bound of the search fits as well."
    )


def _flat(solution: Solution, index: int, interval: Interval) -> tuple[list[str], float, float]:
    """The measured quantities, and the range of a parameter in which none of them changes.

    The other parameters stay at their best. A change smaller than the uncertainty of a row does not count.
    """
    along = np.repeat(solution.survey.best[None], PLACES, axis=0)
    along[:, index] = np.linspace(interval.low, interval.high, PLACES)
    rows = solution.survey.likelihood.surrogate(along)
    off = np.abs(rows - solution.fitted) / solution.survey.likelihood.misfit.total
    middle = int(np.argmin(np.abs(along[:, index] - interval.best)))
    changed = np.flatnonzero(off.max(axis=1) > 1)
    first = max(changed[changed < middle], default=-1) + 1
    last = min(changed[changed > middle], default=PLACES) - 1
    measured = [one.quantity.words for test in solution.runs.tests for one in test.measured]
    low, high = (solution.coordinates.value(index, along[place, index]) for place in (first, last))
    wide = along[last, index] - along[first, index] >= WIDE * (interval.high - interval.low)
    return (list(dict.fromkeys(measured)) if wide else []), low, high


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


def remarks(solution: Solution) -> list[str]:
    """Sentences about measurements that the model misses, and about intervals that are approximate."""
    said = []
    survey = solution.survey
    if survey.widened > 1:
        said.append(
            f"The misfit is {np.sqrt(survey.widened):.2g} times what the uncertainties explain, and the "
            "intervals were widened by this factor: the model is incomplete, or the uncertainties are larger."
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
                    f"The {one.quantity.words} of test '{test.name}' does not fit: measured "
                    f"{length(one.value[0], unit)}, fitted {length(solution.fitted[row], unit)}."
                )
    if not survey.agrees:
        said.append(
            "At the ends of the intervals, the runs differ from the surface through them: "
            "the intervals are approximate."
        )
    return said
