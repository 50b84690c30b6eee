"""One model fitted to the measurements: from a first guess, coarse models first, to intervals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from ..errors import CaseError
from .coordinates import Coordinates
from .descent import Descent
from .first_guess import first_guess
from .measurements import Measured
from .misfit import Misfit
from .model_error import COARSEST_GUESS, ModelError, from_coarser
from .runs import Point, Runs, Spent, require
from .survey import Survey, Surveyor

MISSED = 3.0
"""A number missed by more of its standard uncertainties gets a sentence."""
AT_A_BOUND = 0.01
"""A parameter closer to its bound than this part of the box counts as at its bound."""


@dataclass(frozen=True)
class Solution:
    """The solution of a fit."""

    runs: Runs
    coordinates: Coordinates
    stage: int
    survey: Survey
    errors: list[ModelError | None]
    """model error of each test; None if it is not known"""
    said: list[str]
    """sentences about how it was found"""

    @property
    def values(self) -> dict[str, float]:
        """Best values by path."""
        return self.coordinates.values(self.survey.best)

    @property
    def fitted(self) -> np.ndarray:
        """The rows at the best values, ``(m,)``."""
        return self.survey.likelihood.surrogate(self.survey.best)


def solve(runs: Runs, coordinates: Coordinates, known: list[ModelError | None], level: float) -> Solution:
    """Fit the parameters.

    Args:
        runs: of the tests.
        coordinates: of the parameters.
        known: the errors of the finest models; None for an unknown error.
        level: of the intervals.

    Raises:
        CaseError: the budget is too small, or the model cannot give what was measured.
        GuardStop: a guard stopped a run that the fit needs.
    """
    measured = [one for test in runs.tests for one in test.measured]
    u, said = first_guess(coordinates, runs.tests)
    errors, reached, spent = list(known), -1, False
    for stage in range(runs.stages):
        try:
            if stage == runs.last:
                errors = _errors(runs, coordinates, u, known)
            parts = [_assumed(error, stage == runs.last) for error in errors]
            u = Descent(runs, stage, coordinates).from_(u, partial(_misfit_at, runs, measured, parts))
            reached = stage
        except Spent:
            spent = True
            break
    for stage in range(max(reached, 0) + spent, -1, -1):
        if stage > runs.last:
            continue
        parts = [_assumed(error, stage == runs.last) for error in errors]
        try:
            survey = _surveyor(runs, stage, coordinates, measured, parts, level).around(u)
        except Spent:
            continue
        if spent or survey.spent:
            said.append(
                "The budget was used up before the fit had finished. Give a larger budget: the fit then "
                "continues from here."
            )
        found = Solution(runs, coordinates, stage, survey, errors, said)
        _refuse_what_no_run_gives(found, measured)
        return found
    raise CaseError(
        f"budget: it is too small for the first search; a search of {len(coordinates)} parameters needs "
        f"about {10 * len(runs.tests) * (len(coordinates) + 1)} runs"
    )


def _surveyor(
    runs: Runs,
    stage: int,
    coordinates: Coordinates,
    measured: list[Measured],
    parts: list[float],
    level: float,
) -> Surveyor:
    known = [p for p in runs.points if p.stage == stage and p.predicted is not None]
    if not known:
        raise Spent
    scale = require(min(known, key=lambda point: _roughly(point, measured))).scale

    def misfit(missed: np.ndarray) -> Misfit:
        errors = _rows(runs, parts) * scale
        return Misfit(measured, np.hypot(errors, missed))

    return Surveyor(runs, stage, coordinates, misfit, level)


def _roughly(point: Point, measured: list[Measured]) -> float:
    """χ² without the model's error."""
    plain = Misfit(measured, np.zeros(sum(len(one.value) for one in measured)))
    return float(np.sum(plain.residuals(require(point).value) ** 2))


def _errors(
    runs: Runs, coordinates: Coordinates, u: np.ndarray, known: list[ModelError | None]
) -> list[ModelError | None]:
    """Errors of the finest models. An unknown one is found from the next coarser model at the same
    point."""
    if runs.stages == 1 or None not in known:
        return known
    values = [coordinates.values(np.clip(u, 1e-6, 1 - 1e-6))]
    coarse, fine = (require(runs.at(stage, values)[0]) for stage in (runs.last - 1, runs.last))
    found, start = [], 0
    for test, error in zip(runs.tests, known, strict=True):
        rows = slice(start, start + sum(len(one.value) for one in test.measured))
        start = rows.stop
        if error is None and len(test.stages) > 1:
            error = from_coarser(test, coarse.value[rows], fine.value[rows], fine.scale[rows])
        found.append(error)
    return found


def _assumed(error: ModelError | None, finest: bool) -> float:
    part = 0.0 if error is None else error.part
    return part if finest else max(part, COARSEST_GUESS)


def _rows(runs: Runs, parts: list[float]) -> np.ndarray:
    """The error of each row's test."""
    counts = [sum(len(one.value) for one in test.measured) for test in runs.tests]
    return np.repeat(parts, counts)


def _misfit_at(runs: Runs, measured: list[Measured], parts: list[float], first: Point) -> Misfit:
    """The misfit with the model's error as it is at a point."""
    return Misfit(measured, _rows(runs, parts) * require(first).scale)


def _refuse_what_no_run_gives(found: Solution, measured: list[Measured]) -> None:
    """Refuse a measurement that the fit misses by far while a parameter is at its bound.

    Raises:
        CaseError: the sentence names the nearest possible value.
    """
    bound = [index for index, u in enumerate(found.survey.best) if not AT_A_BOUND <= u <= 1 - AT_A_BOUND]
    if not bound:
        return
    total, start = found.survey.likelihood.misfit.total, 0
    for one in measured:
        row = start
        start += len(one.value)
        if one.is_curve or abs(found.fitted[row] - one.value[0]) <= MISSED * total[row]:
            continue
        names = " and ".join(
            f"{path} from {p.low:g} to {p.high:g}"
            for path, p in zip(found.coordinates.paths, found.coordinates.parameters, strict=True)
        )
        at = ", ".join(
            f"{found.coordinates.paths[i]} = {found.values[found.coordinates.paths[i]]:.4g}" for i in bound
        )
        raise CaseError(
            f"{one.where}.value: no {names} gives a {one.quantity.words} of {one.value[0]:.4g} "
            f"{one.quantity.unit}; {found.fitted[row]:.4g} {one.quantity.unit} is the nearest value, at the "
            f"bound {at}"
        )
