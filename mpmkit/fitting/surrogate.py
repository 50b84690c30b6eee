"""A polynomial through the runs: what the tests give at any point near the best one, at once.

Profiles need the model at thousands of points. A polynomial in the coordinates, of degree 1 to 3 by what the
runs bear, follows the smooth curves that spreads and times are over the width of an interval, has no length
scale that has to be guessed from a dozen runs, as a Gaussian process has, and averages the noise of single
runs.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

SPARE = 1.3
"""Runs for each coefficient, at the least, of a degree that may be chosen."""
HIGHEST = 3


class Surrogate:
    """Rows y(u) as weighted polynomials.

    Args:
        u: coordinates of the runs, ``(k, n)``.
        y: what they gave, ``(k, m)``.
        weight: of each run, ``(k,)``, largest near the best.
        scale: of the rows, ``(m,)``, by which the errors of two degrees are compared.
    """

    def __init__(self, u: np.ndarray, y: np.ndarray, weight: np.ndarray, scale: np.ndarray) -> None:
        self._middle = np.average(u, axis=0, weights=weight)
        spread = np.sqrt(np.average((u - self._middle) ** 2, axis=0, weights=weight))
        self._width = np.where(spread > 1e-9, spread, 1.0)
        best: tuple[float, int, np.ndarray, np.ndarray] | None = None
        for degree in range(1, HIGHEST + 1):
            if len(u) < SPARE * count(u.shape[1], degree) and degree > 1:
                break
            coefficients, left_out = self._fitted(u, y, weight, degree)
            error = np.sqrt(np.average(left_out**2, axis=0, weights=weight))
            size = float(np.sqrt(np.mean((error / scale) ** 2)))
            if best is None or size < best[0]:
                best = (size, degree, coefficients, error)
        assert best is not None
        _, self.degree, self.coefficients, self.error = best
        """``error``, ``(m,)``: how far a run lies from the polynomial of the others"""

    def _fitted(
        self, u: np.ndarray, y: np.ndarray, weight: np.ndarray, degree: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients, and by how much each run is missed when it is left out."""
        terms, root = self._terms(u, degree), np.sqrt(weight)[:, None]
        inverse = np.linalg.pinv(root * terms, rcond=1e-8)
        coefficients = inverse @ (root * y)
        own = np.einsum("ij,ji->i", root * terms, inverse)
        return coefficients, (y - terms @ coefficients) / np.maximum(1 - own, 0.1)[:, None]

    def _terms(self, u: np.ndarray, degree: int) -> np.ndarray:
        x = (u - self._middle) / self._width
        found: dict[tuple[int, ...], np.ndarray] = {(): np.ones(x.shape[:-1])}
        for which in _powers(u.shape[-1], degree)[1:]:
            found[which] = found[which[:-1]] * x[..., which[-1]]
        return np.stack(list(found.values()), axis=-1)

    def terms(self, u: np.ndarray) -> np.ndarray:
        """Terms of the polynomial, ``(…, t)``, at ``(…, n)``: y = terms · coefficients."""
        return self._terms(u, self.degree)

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """y, ``(…, m)``, at ``(…, n)``."""
        return self.terms(u) @ self.coefficients

    def slopes(self, u: np.ndarray) -> np.ndarray:
        """dy/du at one point, ``(m, n)``."""
        small = 1e-4 * np.eye(len(u))
        return np.stack([(self(u + step) - self(u - step)) / 2e-4 for step in small], axis=1)


def count(n: int, degree: int) -> int:
    """Coefficients of a polynomial in n coordinates."""
    return math.comb(n + degree, degree)


def _powers(n: int, degree: int) -> list[tuple[int, ...]]:
    return [
        which
        for power in range(degree + 1)
        for which in itertools.combinations_with_replacement(range(n), power)
    ]
