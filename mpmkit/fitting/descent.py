"""Least squares with runs: SciPy's bounded trust region method; parallel runs give the derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from .coordinates import Coordinates
from .misfit import Misfit
from .runs import Point, Runs, require

TOLERANCE = 3e-3
"""Relative change of χ², and of the coordinates, below which a search ends."""
MOST_STEPS = 8
"""Most points that a stage tries, besides those for derivatives."""
FLOOR = 3.0
"""A constant residual: the search ends when χ² falls by less than ``TOLERANCE`` (χ² + 9)."""
REFUSED = 1e3
"""Residual of every row if a guard stopped the run: the search then rejects the step and shortens it."""


class _Converged(Exception):
    """The next step would gain too little."""


class Descent:
    """A search in one stage.

    Each point is run together with its neighbours, which are needed next if the step is accepted. So all
    cores are used, and the runs are the same on any number of cores. A step from which the derivatives
    promise too little is not made: SciPy would make its runs only to find this confirmed.

    Args:
        runs: of the tests.
        stage: number of the stage.
        coordinates: of the parameters.
    """

    def __init__(self, runs: Runs, stage: int, coordinates: Coordinates) -> None:
        self._runs, self._stage, self._coordinates = runs, stage, coordinates

    def points(self, u: np.ndarray) -> list[Point]:
        """The point, and its neighbour along each coordinate."""
        steps = np.diag(self._coordinates.steps(u))
        return self._runs.at(
            self._stage, [self._coordinates.values(place) for place in (u, *(u + step for step in steps))]
        )

    def from_(self, start: np.ndarray, misfit: Callable[[Point], Misfit]) -> np.ndarray:
        """Coordinates of the smallest misfit found.

        Args:
            start: where it begins.
            misfit: made at the first point, and kept for the whole search.

        Raises:
            GuardStop: a guard stopped the first run, or one that a derivative needs.
            Spent: the budget is at its end.
        """
        inside = np.clip(start, 1e-6, 1 - 1e-6)
        first = self.points(inside)[0]
        require(first)
        measure = misfit(first)

        known: dict[str, np.ndarray] = {}

        def residuals(u: np.ndarray) -> np.ndarray:
            if known:
                before = known["r"]
                after = before + known["slopes"] @ (u - known["u"])
                if before @ before - after @ after < TOLERANCE * before @ before:
                    raise _Converged
            point = self.points(u)[0]
            if point.predicted is None:
                return np.full(len(measure) + len(self._coordinates.prior_residuals(u)) + 1, REFUSED)
            return np.concatenate(
                [measure.residuals(point.predicted.value), self._coordinates.prior_residuals(u), [FLOOR]]
            )

        def slopes(u: np.ndarray) -> np.ndarray:
            here, *others = (require(point).value for point in self.points(u))
            steps = self._coordinates.steps(u)
            likely = np.stack(
                [measure.whitened(other - here) / h for other, h in zip(others, steps, strict=True)], axis=1
            )
            found = np.vstack([likely, self._prior_slopes(u), np.zeros(len(u))])
            known.update(u=u, slopes=found)
            known["r"] = np.concatenate(
                [measure.residuals(here), self._coordinates.prior_residuals(u), [FLOOR]]
            )
            return found

        try:
            found = self._search(residuals, slopes, inside)
        except _Converged:
            return known["u"]
        return np.asarray(found.x)

    @staticmethod
    def _search(residuals: Callable, slopes: Callable, inside: np.ndarray) -> OptimizeResult:
        return least_squares(
            residuals,
            inside,
            slopes,
            bounds=(0.0, 1.0),
            method="trf",
            ftol=TOLERANCE,
            xtol=TOLERANCE,
            gtol=None,
            max_nfev=MOST_STEPS,
        )

    def _prior_slopes(self, u: np.ndarray) -> np.ndarray:
        at = self._coordinates.prior_residuals
        small = 1e-6 * np.eye(len(u))
        return np.stack([(at(u + step) - at(u - step)) / 2e-6 for step in small], axis=1)
