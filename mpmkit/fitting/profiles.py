"""Profile likelihoods on the surrogate: intervals without the assumption of a normal distribution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import gammaincc, gammaincinv

from .coordinates import Coordinates
from .misfit import Misfit
from .surrogate import Surrogate

PLACES = 41
"""Places along a coordinate at which a profile is computed; as many more are near the best value."""
SMALL = 1e-4
"""Step of a coordinate for finite differences of the surface."""
ITERATIONS = 60
CLOSE = 1e-7
"""A search on the surface ends when the coordinates change by less."""
SEED, TRIED = 5, 400
"""Points of the box at which the shapes of the residuals are collected."""
NEGLIGIBLE = 1e-9
"""Relative size below which a shape is left out."""
UNIFORM = 12.0
"""1/variance of a coordinate that is uniformly distributed from 0 to 1."""
DOUBTFUL = 0.05
"""If a misfit as large has a smaller probability, the stated uncertainties are taken as too small."""


@dataclass(frozen=True)
class Interval:
    """The interval and the profile of one parameter, along its coordinate."""

    best: float
    low: float
    high: float
    low_at: np.ndarray
    """the point of least χ² with the coordinate at the lower end, ``(n,)``"""
    high_at: np.ndarray
    low_open: bool
    """whether the interval is cut off at the lower bound"""
    high_open: bool
    place: np.ndarray
    """places along the coordinate, ``(p,)``"""
    excess: np.ndarray
    """Δχ² there, the other parameters at their best, ``(p,)``"""


class Likelihood:
    """χ² on the surrogate at many points of the box at once.

    A curve with hundreds of rows has far fewer independent shapes. The residuals r are projected to the
    shapes that points of the box have, which leaves the same χ² of fewer numbers.

    Args:
        surrogate: of the finest model.
        misfit: of the measurements.
        coordinates: of the parameters.
    """

    def __init__(self, surrogate: Surrogate, misfit: Misfit, coordinates: Coordinates) -> None:
        self.surrogate, self.misfit, self.coordinates = surrogate, misfit, coordinates
        tried = np.random.default_rng(SEED).random((TRIED, len(coordinates)))
        off = misfit.whitened((surrogate(tried) - misfit.value).T)
        axes, size, _ = np.linalg.svd(off, full_matrices=False)
        axes = axes[:, size > NEGLIGIBLE * size[0]]
        self._short = misfit.whitened(np.eye(len(misfit))).T @ axes

    def residuals(self, u: np.ndarray) -> np.ndarray:
        """Residuals whose squares add up to χ², ``(…, q)``, at points ``(…, n)``; priors come last."""
        own = (self.surrogate(u) - self.misfit.value) @ self._short
        return np.concatenate([own, self.coordinates.prior_residuals(u)], axis=-1)

    def chi2(self, u: np.ndarray) -> np.ndarray:
        """χ² with the priors, ``(…,)``."""
        return np.sum(self.residuals(u) ** 2, axis=-1)

    def slopes(self, u: np.ndarray) -> np.ndarray:
        """dr/du, ``(…, q, n)``."""
        steps = SMALL * np.eye(u.shape[-1])
        return np.stack(
            [(self.residuals(u + step) - self.residuals(u - step)) / (2 * SMALL) for step in steps], axis=-1
        )

    def covariance(self, u: np.ndarray) -> np.ndarray:
        """Covariance of the coordinates at a point, ``(n, n)``, limited by the size of the box."""
        slopes = self.slopes(u)
        return np.linalg.inv(slopes.T @ slopes + UNIFORM * np.eye(len(u)))

    def minimum(self, near: np.ndarray) -> np.ndarray:
        """The point of least χ² near another one, ``(n,)``."""
        return self._least(near[None], np.ones(len(near), dtype=bool))[0]

    def _least(self, u: np.ndarray, free: np.ndarray) -> np.ndarray:
        """Points of least χ² in the box, ``(k, n)``, from ``k`` starts, by the Levenberg-Marquardt method.

        Coordinates that are not ``free``, ``(n,)``, are fixed; so is one at a bound beyond which χ² falls.
        """
        unit = np.eye(u.shape[1])
        u, chi2, damping = np.clip(u, 0, 1), self.chi2(np.clip(u, 0, 1)), np.full(len(u), 1e-3)
        for _ in range(ITERATIONS):
            r, slopes = self.residuals(u), self.slopes(u)
            gradient = np.einsum("kqn,kq->kn", slopes, r)
            held = ~free | ((u <= 0) & (gradient > 0)) | ((u >= 1) & (gradient < 0))
            matrix = np.einsum("kqn,kqm->knm", slopes, slopes)
            size = damping * (1 + np.trace(matrix, axis1=1, axis2=2))
            matrix += size[:, None, None] * unit
            matrix = np.where(held[:, :, None] | held[:, None, :], unit, matrix)
            change = np.linalg.solve(matrix, np.where(held, 0.0, -gradient)[..., None])[..., 0]
            tried = np.clip(u + change, 0, 1)
            if np.abs(tried - u).max() < CLOSE:
                break
            found = self.chi2(tried)
            better = found <= chi2
            u, chi2 = np.where(better[:, None], tried, u), np.where(better, found, chi2)
            damping = np.where(better, damping / 5, np.minimum(damping * 5, 1e8))
        return u

    def intervals(self, best: np.ndarray, crit: float) -> list[Interval]:
        """Where the profile of each coordinate lies less than ``crit`` above its least value.

        An end of another coordinate's interval also fits. If it lies beyond a small bump of the profile, the
        interval goes on to there.
        """
        found = [self.interval(index, best, crit) for index in range(len(best))]
        ends = np.array([end for one in found for end in (one.low_at, one.high_at)])
        least, most = ends.min(axis=0), ends.max(axis=0)
        for index, one in enumerate(found):
            if least[index] < one.low - CLOSE or most[index] > one.high + CLOSE:
                found[index] = self.interval(index, best, crit, (least[index], most[index]))
        return found

    def interval(
        self, index: int, best: np.ndarray, crit: float, inside: tuple[float, float] | None = None
    ) -> Interval:
        """Where the profile of one coordinate lies less than ``crit`` above its least value.

        Args:
            index: of the coordinate.
            best: the point of least χ².
            crit: Δχ² at the ends.
            inside: a range of the coordinate that is known to fit.
        """
        first, last = inside or (best[index], best[index])
        width = float(np.sqrt(self.covariance(best)[index, index]))
        near = best[index] + width * np.linspace(-4, 4, PLACES)
        place = np.unique(np.clip(np.concatenate([np.linspace(0, 1, PLACES), near, [best[index]]]), 0, 1))
        middle = int(np.searchsorted(place, best[index]))
        free = np.arange(len(best)) != index
        along = self.covariance(best)[:, index]
        valley = best + (place - best[index])[:, None] * (along / along[index])
        straight = np.repeat(best[None], len(place), axis=0)
        straight[:, index] = valley[:, index] = place
        tried = [self._least(start, free) for start in (valley, straight)]
        lower = (self.chi2(tried[0]) <= self.chi2(tried[1]))[:, None]
        points = np.where(lower, *tried)
        points[middle] = best
        excess = self.chi2(points) - self.chi2(best)
        low, low_at, low_open = _end(place, points, excess - crit, middle, -1, first)
        high, high_at, high_open = _end(place, points, excess - crit, middle, +1, last)
        return Interval(float(best[index]), low, high, low_at, high_at, low_open, high_open, place, excess)


def _end(
    place: np.ndarray, points: np.ndarray, above: np.ndarray, middle: int, way: int, inside: float
) -> tuple[float, np.ndarray, bool]:
    """Where the excess first rises above the limit on one side beyond a place that is known to fit, the point
    there, and whether it never does."""
    number = middle
    while 0 <= number + way < len(place):
        if above[number + way] > 0 and way * (place[number + way] - inside) > 0:
            part = above[number] / (above[number] - above[number + way]) if above[number] <= 0 else 0.0
            at = points[number] + part * (points[number + way] - points[number])
            return float(place[number] + part * (place[number + way] - place[number])), at, False
        number += way
    return float(place[number]), points[number], True


def critical(level: float) -> float:
    """Δχ² of one parameter at a confidence level (Wilks's theorem)."""
    return float(2 * gammaincinv(0.5, level))


def widening(chi_squared: float, freedom: int) -> float:
    """Birge's ratio squared, χ²/ν, if the misfit is too large to be chance; else 1."""
    if freedom < 1 or gammaincc(freedom / 2, chi_squared / 2) > DOUBTFUL:
        return 1.0
    return chi_squared / freedom
