"""The further measurement that would reduce the uncertainty most, of all quantities that the runs record."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .quantities import FIGURES, LENGTHS, Quantity
from .runs import Point, Test
from .solve import Solution
from .surrogate import Surrogate
from .words import Names

OF_LENGTHS, OF_TIMES = 0.02, 0.05
"""Assumed relative uncertainties of a measured length and of a measured time."""
PARTS = (0.05, 0.1, 0.2, 0.3, 0.5, 0.75)
"""Times, relative to the run time, at which measurements of histories are considered."""
HISTORIES = ("spread_diameter", "height")
WORTH = 0.9
"""A measurement is named only if it would leave at most this part of the interval."""


@dataclass(frozen=True)
class Further:
    """A measurement that was not made."""

    test: str
    words: str
    parameter: str
    uncertainty: float
    """assumed relative uncertainty"""
    left: float
    """part of the parameter's standard deviation that would remain"""


def further(solution: Solution) -> list[Further]:
    """Measurements sorted by how much they would reduce the largest uncertainty, the best first.

    A measurement with the slope g and the uncertainty s changes the covariance P of the parameters to
    P − P g gᵀ P/(s² + gᵀ P g).
    """
    covariance = solution.survey.likelihood.covariance(solution.survey.best) * solution.survey.widened
    worst = int(np.argmax(np.diag(covariance)))
    points = [p for p in solution.runs.points if p.stage == solution.stage and p.predicted is not None]
    u = np.array(
        [[solution.coordinates.coordinate(i, v) for i, v in enumerate(p.values.values())] for p in points]
    )
    distance = np.sum((u - solution.survey.best) ** 2 / np.diag(covariance), axis=1)
    weight = 1 / (1 + distance / 4)
    found = []
    for number, test in enumerate(solution.runs.tests):
        quantities = _candidates(test, solution)
        y = _rows(solution, points, number, quantities)
        for index, quantity in enumerate(quantities):
            row = y[:, index]
            if not np.isfinite(row).all() or not np.abs(row).max() > 0:
                continue
            part = OF_TIMES if quantity.is_time else OF_LENGTHS
            known = Surrogate(u, row[:, None], row[:, None], weight, np.array([np.abs(row).max()]))
            slope = known.slopes(solution.survey.best)[0]
            noise = math.hypot(part * abs(float(known(solution.survey.best)[0])), float(known.error[0]))
            gain = covariance @ slope
            left = 1 - gain[worst] ** 2 / (noise**2 + slope @ gain) / covariance[worst, worst]
            found.append(
                Further(
                    test.name,
                    quantity.words,
                    solution.coordinates.paths[worst],
                    part,
                    math.sqrt(max(left, 0.0)),
                )
            )
    return sorted(found, key=lambda one: one.left)


def sentence(found: list[Further], names: Names) -> str:
    """A sentence about the best of them."""
    if not found or found[0].left > WORTH:
        return "No other quantity of these tests would reduce the uncertainty much; another kind of test may."
    best = found[0]
    return (
        f"The most useful further measurement is the {best.words} in test '{best.test}': measured to "
        f"{100 * best.uncertainty:g} %, it would reduce the uncertainty of the {names.name(best.parameter)} "
        f"to {100 * best.left:.0f} %."
    )


def _candidates(test: Test, solution: Solution) -> list[Quantity]:
    measured = {one.quantity.variable for one in test.measured}
    until = test.stages[-1].case.end
    figures = [Quantity(name) for name in FIGURES if name in (*LENGTHS, "t500", "t500_from_lift")]
    if all(one.quantity.times is not None for one in test.measured):
        figures = [one for one in figures if one.is_time]  # the runs end with the curve, and not at rest
    histories = [Quantity(name, (round(part * until, 6),)) for name in HISTORIES for part in PARTS]
    return [one for one in figures + histories if one.variable not in measured]


def _rows(solution: Solution, points: list[Point], number: int, quantities: list[Quantity]) -> np.ndarray:
    """The quantities of each run, ``(k, q)``; NaN if one did not occur."""
    rows = np.full((len(points), len(quantities)), np.nan)
    for place, point in enumerate(points):
        member = point.members[number]
        history, summary = solution.runs.history(member), solution.runs.record(member)["summary"]
        if history is None:
            continue
        for index, quantity in enumerate(quantities):
            if quantity.is_time and summary.get(quantity.variable) is None:
                continue
            rows[place, index] = quantity.of_run(summary, history)[0][0]
    return rows
