"""A polynomial through the runs: it predicts the tests at points near the best one without new runs.

Profiles need the model at thousands of points. Spreads and times are smooth over the width of an interval, so
that a polynomial in the coordinates follows them. Its degree, 1 to 3, depends on the number of runs. Unlike a
Gaussian process, it needs no length scale, which a dozen runs could not determine. It also averages the noise
of single runs.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

SPARE = 1.3
"""Least number of runs per coefficient for a degree to be allowed."""
HIGHEST = 3


class Surrogate:
    """Rows y(u) as weighted polynomials.

    Args:
        u: coordinates of the runs, ``(k, n)``.
        y: their results, ``(k, m)``.
        weight: of each run, ``(k,)``, largest near the best.
        scale: of the rows, ``(m,)``, to compare the errors of two degrees.
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
        """``error``, ``(m,)``: typical distance of a run from the polynomial through the others"""

    def _fitted(
        self, u: np.ndarray, y: np.ndarray, weight: np.ndarray, degree: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients, and the error of the prediction of each run when it is left out."""
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
    """Number of coefficients of a polynomial in n coordinates."""
    return math.comb(n + degree, degree)


def _powers(n: int, degree: int) -> list[tuple[int, ...]]:
    return [
        which
        for power in range(degree + 1)
        for which in itertools.combinations_with_replacement(range(n), power)
    ]
