"""Runs around the best point, until the surrogate agrees with the runs there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .coordinates import Coordinates
from .measurements import Bounds
from .misfit import Misfit
from .profiles import Interval, Likelihood, critical, widening
from .runs import Point, Runs, Spent
from .surrogate import Surrogate

ROUNDS = 7
"""How often runs are added at the ends of the intervals, at most."""
AGREES = 0.5
"""Allowed error of the surrogate at the ends of an interval, relative to the critical Δχ²."""
WIDE = 0.12
"""If the standard deviation of a coordinate is larger, runs cover it from bound to bound."""
CLOSE = 0.05
"""A run is as good as one at another place if it is closer, relative to the width of the intervals."""
FAR = 1.5
"""Distance of the first runs from the best point, in standard deviations."""


@dataclass(frozen=True)
class Survey:
    """The result of the runs around the best point."""

    likelihood: Likelihood
    best: np.ndarray
    intervals: list[Interval]
    bounded: list[bool]
    """whether the measurements, without priors, bound each parameter on both sides"""
    chi2: float
    widened: float
    """χ²/ν if it is too large to be chance; else 1"""
    agrees: bool
    """whether the surrogate agrees with runs at the ends of the intervals"""
    spent: bool
    """whether the budget ended before that"""


class Surveyor:
    """Makes the runs that the intervals need.

    Args:
        runs: of the tests.
        stage: number of the finest model.
        coordinates: of the parameters.
        misfit: of the measurements, for an error of the surrogate, ``(m,)``.
        level: of the intervals.
    """

    def __init__(
        self,
        runs: Runs,
        stage: int,
        coordinates: Coordinates,
        misfit: Callable[[np.ndarray], Misfit],
        level: float,
    ) -> None:
        self._runs, self._stage, self._coordinates = runs, stage, coordinates
        self._misfit, self._level = misfit, level

    def around(self, start: np.ndarray) -> Survey:
        """Survey the neighbourhood of the result of a search.

        Raises:
            Spent: the budget is too small even for a polynomial of degree 1.
        """
        spent = False
        try:
            self._run(self._first(start))
        except Spent:
            spent = True
        found = self._found(start, agrees=False, spent=spent)
        for _ in range(0 if spent else ROUNDS):
            ends = [end for interval in found.intervals for end in (interval.low_at, interval.high_at)]
            try:
                points = self._run([self._nearest(found, found.best), *ends])
            except Spent:
                return self._found(found.best, agrees=False, spent=True)
            if all(self._agrees(found, point) for point in points):
                return replace(found, agrees=True)  # this surrogate is the one that the runs have confirmed
            found = self._found(found.best, agrees=False, spent=False)
        return found

    def _run(self, places: list[np.ndarray]) -> list[Point]:
        return self._runs.at(
            self._stage, [self._coordinates.values(np.clip(place, 0, 1)) for place in places]
        )

    def _nearest(self, found: Survey, place: np.ndarray) -> np.ndarray:
        """The place of a finished run that is as good as at this place; the place itself if there is none."""
        width = np.array([interval.high - interval.low for interval in found.intervals])
        known = [self._u(p) for p in self._runs.points if p.stage == self._stage and p.predicted is not None]
        near = min(known, key=lambda u: float(np.max(np.abs(u - place) / width)))
        return near if np.all(np.abs(near - place) <= CLOSE * width) else place

    def _u(self, point: Point) -> np.ndarray:
        return np.array(
            [self._coordinates.coordinate(i, value) for i, value in enumerate(point.values.values())]
        )

    def _first(self, start: np.ndarray) -> list[np.ndarray]:
        """Points on both sides of the best for each parameter; the others follow by the covariance."""
        likelihood = self._likelihood()
        covariance = likelihood.covariance(start)
        places = []
        for index, step in enumerate(np.abs(self._coordinates.steps(start))):
            width = float(np.sqrt(covariance[index, index]))
            along = covariance[:, index] / covariance[index, index]
            if width > WIDE:
                to = np.linspace(0, 1, 5) - start[index]
            else:
                to = np.array([-1, 1]) * max(FAR * width, step)
            places += [np.clip(start + along * change, 0, 1) for change in to]
        return places

    def _likelihood(self) -> Likelihood:
        """The surrogate through all runs of the finest model, weighted by how well each fits."""
        known = [
            (point, point.bounds)
            for point in self._runs.points
            if point.stage == self._stage and point.bounds is not None
        ]
        u = np.array([self._u(point) for point, _ in known])
        complete = np.array([point.predicted is not None for point, _ in known])
        if len(np.unique(u[complete], axis=0)) <= len(self._coordinates):
            raise Spent
        low, high = (np.array([getattr(bounds, end) for _, bounds in known]) for end in ("low", "high"))
        plain = self._misfit(np.zeros(low.shape[1]))
        chi2 = np.array([_least(plain, bounds) for _, bounds in known])
        least = chi2[complete].min()
        weight = 1 / (
            1 + np.maximum(chi2 - least, 0) / (4 * critical(self._level) * _per_row(least, len(plain)))
        )
        surrogate = Surrogate(u, low, high, weight, plain.total)
        return Likelihood(surrogate, self._misfit(surrogate.error), self._coordinates)

    def _found(self, near: np.ndarray, agrees: bool, spent: bool) -> Survey:
        likelihood = self._likelihood()
        best = likelihood.minimum(near)
        chi2 = float(likelihood.chi2(best))
        freedom = len(likelihood.misfit) - len(best)
        widened = widening(
            float(np.sum(likelihood.misfit.residuals(likelihood.surrogate(best)) ** 2)), freedom
        )
        crit = critical(self._level) * widened
        intervals = likelihood.intervals(best, crit)
        bounded = [not (interval.low_open or interval.high_open) for interval in intervals]
        if self._coordinates.have_priors:
            free = Likelihood(likelihood.surrogate, likelihood.misfit, self._coordinates.without_priors())
            alone = [free.interval(index, free.minimum(best), crit) for index in range(len(best))]
            bounded = [not (interval.low_open or interval.high_open) for interval in alone]
        return Survey(likelihood, best, intervals, bounded, chi2, widened, agrees, spent)

    def _agrees(self, found: Survey, point: Point) -> bool:
        """Whether a run has the χ² that the surrogate has there."""
        if point.bounds is None:
            return True  # nothing is known there
        u = self._u(point)
        run = _least(found.likelihood.misfit, point.bounds)
        run += float(np.sum(self._coordinates.prior_residuals(u) ** 2))
        off = run - float(found.likelihood.chi2(u))
        if point.predicted is None:
            off = max(off, 0.0)  # the χ² of a run that ended early is at least this
        return abs(off) <= AGREES * critical(self._level) * found.widened


def _least(misfit: Misfit, bounds: Bounds) -> float:
    """χ² of a run; of one that ended early, with the values within its bounds nearest to the measured."""
    nearest = np.clip(misfit.value, bounds.low, bounds.high)
    return float(np.sum(misfit.residuals(nearest) ** 2))


def _per_row(chi2: float, rows: int) -> float:
    """χ² per row, at least 1: if no run fits well, slightly worse runs get a similar weight."""
    return max(1.0, chi2 / rows)
