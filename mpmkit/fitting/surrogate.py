"""A smooth surface through the runs: it predicts the tests at points near the best one without new runs.

Profiles need the model at thousands of points. Spreads and times are smooth over the width of an interval, so
that a polynomial in the coordinates follows them. Unlike a Gaussian process, it needs no length scale, which
a dozen runs could not determine, and it averages the noise of single runs.

Three things let the surface follow the tests over decades of a parameter as well:

- Rows that are positive in all runs may be modelled by their logarithm. A spread at rest is a power of the
  yield stress, and its logarithm is a straight line.
- A run that ended early because material left the domain still says something: its spread is at least the
  last one. Each row of a run is an interval [low, high], and the distance to the interval is what counts
  (regression with censored data; Tobin, Econometrica 26 (1958) 24).
- Besides polynomials, a smoothing spline is tried, y = Σ cᵢ |u − uᵢ|³ + a plane (Duchon 1977), which has no
  length scale either, and bends only where runs ask for it.

Of all these surfaces, the one is taken that best predicts runs that are left out.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

SPARE = 1.3
"""Least number of runs per coefficient for a degree to be allowed."""
HIGHEST = 3
SMOOTHING = (1e-4, 1e-2)
"""Smoothing of the splines that are tried, relative to the mean of |u − uᵢ|³."""
TURNS = 30
"""Most rounds in which bounds that the surface violates are taken in, and others are released."""


@dataclass(frozen=True)
class Kind:
    """A kind of surface."""

    degree: int
    """of the polynomial"""
    smoothing: float | None
    """of the spline; None for a polynomial alone"""
    logarithmic: np.ndarray
    """whether a row is modelled by its logarithm, ``(m,)``"""


class Surrogate:
    """Rows y(u) as surfaces.

    Args:
        u: coordinates of the runs, ``(k, n)``.
        low: least values of their results, ``(k, m)``; −∞ if nothing is known.
        high: largest values, ``(k, m)``; the same as ``low`` in a run that finished.
        weight: of each run, ``(k,)``, largest near the best.
        scale: of the rows, ``(m,)``, to compare the errors of two surfaces.
    """

    kind: Kind
    error: np.ndarray
    """typical distance of a run from the surface through the others, ``(m,)``"""

    def __init__(
        self, u: np.ndarray, low: np.ndarray, high: np.ndarray, weight: np.ndarray, scale: np.ndarray
    ) -> None:
        self._middle = np.average(u, axis=0, weights=weight)
        spread = np.sqrt(np.average((u - self._middle) ** 2, axis=0, weights=weight))
        self._width = np.where(spread > 1e-9, spread, 1.0)
        self._centres = (u - self._middle) / self._width
        least = math.inf
        for kind in _kinds(u.shape[1], low, high):
            coefficients, predicted = self._fitted(kind, low, high, weight)
            missed = predicted - np.clip(predicted, low, high)
            counted = weight[:, None] * ((low == high) | (missed != 0))
            total = np.maximum(np.sum(counted, axis=0), 1e-300)
            error = np.sqrt(np.sum(counted * missed**2, axis=0) / total)
            size = float(np.mean((error / scale) ** 2))
            if size < least:
                least, self.kind, self.error, self._coefficients = size, kind, error, coefficients

    @property
    def degree(self) -> int:
        return self.kind.degree

    def _fitted(
        self, kind: Kind, low: np.ndarray, high: np.ndarray, weight: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients, and the results of each run as the other runs predict them."""
        terms, bends = _terms(self._centres, kind.degree), None
        if kind.smoothing is not None:
            bends = _cubes(self._centres, self._centres)
        lower, upper = (_forward(bound, kind.logarithmic) for bound in (low, high))
        coefficients, predicted = np.empty((self._count(kind), low.shape[1])), np.empty_like(low)
        complete = (low == high).all(axis=0)
        coefficients[:, complete], predicted[:, complete] = _solved(
            terms, bends, lower[:, complete], weight, kind.smoothing
        )
        for row in np.flatnonzero(~complete):
            coefficients[:, row], predicted[:, row] = _censored(
                terms, bends, lower[:, row], upper[:, row], weight, kind.smoothing
            )
        return coefficients, _backward(predicted, kind.logarithmic)

    def _count(self, kind: Kind) -> int:
        own = count(self._centres.shape[1], kind.degree)
        return own if kind.smoothing is None else own + len(self._centres)

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """y, ``(…, m)``, at ``(…, n)``."""
        x = (u - self._middle) / self._width
        terms = _terms(x, self.kind.degree)
        if self.kind.smoothing is not None:
            terms = np.concatenate([terms, _cubes(x, self._centres)], axis=-1)
        return _backward(terms @ self._coefficients, self.kind.logarithmic)

    def slopes(self, u: np.ndarray) -> np.ndarray:
        """dy/du at one point, ``(m, n)``."""
        small = 1e-4 * np.eye(len(u))
        return np.stack([(self(u + step) - self(u - step)) / 2e-4 for step in small], axis=1)


def _kinds(n: int, low: np.ndarray, high: np.ndarray) -> list[Kind]:
    """The surfaces that the number of runs allows, the simplest first."""
    fewest = int((low == high).sum(axis=0).min())
    positive = np.all((low > 0) | ~np.isfinite(low), axis=0) & np.all(high > 0, axis=0)
    found = []
    for logarithmic in (np.zeros_like(positive), positive) if positive.any() else (positive,):
        for degree in range(1, HIGHEST + 1):
            if degree == 1 or fewest >= SPARE * count(n, degree):
                found.append(Kind(degree, None, logarithmic))
        if fewest >= SPARE * count(n, 2):
            found += [Kind(1, smoothing, logarithmic) for smoothing in SMOOTHING]
    return found


def _terms(x: np.ndarray, degree: int) -> np.ndarray:
    """Terms of a polynomial, ``(…, t)``."""
    found: dict[tuple[int, ...], np.ndarray] = {(): np.ones(x.shape[:-1])}
    for which in _powers(x.shape[-1], degree)[1:]:
        found[which] = found[which[:-1]] * x[..., which[-1]]
    return np.stack(list(found.values()), axis=-1)


def _cubes(x: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """|x − xᵢ|³, ``(…, k)``."""
    return np.sum((x[..., None, :] - centres) ** 2, axis=-1) ** 1.5


def _solved(
    terms: np.ndarray, bends: np.ndarray | None, y: np.ndarray, weight: np.ndarray, smoothing: float | None
) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients, and the prediction of each run by the surface through the others."""
    if bends is None or smoothing is None:
        root = np.sqrt(weight)[:, None]
        inverse = np.linalg.pinv(root * terms, rcond=1e-8)
        coefficients = inverse @ (root * y)
        own = np.einsum("ij,ji->i", root * terms, inverse)
        return coefficients, y - (y - terms @ coefficients) / np.maximum(1 - own, 0.1)[:, None]
    k, t = terms.shape
    matrix = np.zeros((k + t, k + t))
    matrix[:k, :k] = bends + np.diag(smoothing * bends.mean() / weight)
    matrix[:k, k:], matrix[k:, :k] = terms, terms.T
    inverse = np.linalg.pinv(matrix, rcond=1e-12)
    bent, plane = inverse[:k, :k] @ y, inverse[k:, :k] @ y
    # The surface through the others misses yᵢ by cᵢ/(A⁻¹)ᵢᵢ (Wahba 1990).
    return np.vstack([plane, bent]), y - bent / np.maximum(np.diag(inverse)[:k, None], 1e-300)


def _censored(
    terms: np.ndarray,
    bends: np.ndarray | None,
    low: np.ndarray,
    high: np.ndarray,
    weight: np.ndarray,
    smoothing: float | None,
) -> tuple[np.ndarray, np.ndarray]:
    """As ``_solved``, for one row, ``(k,)``, with bounds: the distance to [low, high] counts.

    The problem is convex. Bounds that the surface violates are taken in as values, and those that it keeps
    are released, until nothing changes.
    """
    exact = low == high
    now, target = exact, np.where(exact, low, 0.0)
    whole = terms if bends is None else np.hstack([terms, bends])
    for _ in range(TURNS):
        active, coefficients = now, np.zeros(whole.shape[1])
        inside = None if bends is None else bends[np.ix_(active, active)]
        solved, others = _solved(terms[active], inside, target[active, None], weight[active], smoothing)
        used = np.ones(whole.shape[1], dtype=bool)
        used[terms.shape[1] :] = active[: whole.shape[1] - terms.shape[1]]
        coefficients[used] = solved[:, 0]
        predicted = whole @ coefficients
        now = exact | (predicted < low) | (predicted > high)
        if np.array_equal(now, active):
            break
        target = np.clip(predicted, low, high)
    predicted[active] = others[:, 0]
    return coefficients, predicted


def _forward(y: np.ndarray, logarithmic: np.ndarray) -> np.ndarray:
    """ln y of the logarithmic rows, ``(…, m)``."""
    found = np.array(y)
    some = found[..., logarithmic]
    found[..., logarithmic] = np.where(some > 0, np.log(np.where(some > 0, some, 1.0)), -np.inf)
    return found


def _backward(value: np.ndarray, logarithmic: np.ndarray) -> np.ndarray:
    """The inverse of ``_forward``; a value of e³⁰ means that the polynomial was left far behind."""
    found = np.array(value)
    found[..., logarithmic] = np.exp(np.clip(found[..., logarithmic], -30, 30))
    return found


def count(n: int, degree: int) -> int:
    """Number of coefficients of a polynomial in n coordinates."""
    return math.comb(n + degree, degree)


def _powers(n: int, degree: int) -> list[tuple[int, ...]]:
    return [
        which
        for power in range(degree + 1)
        for which in itertools.combinations_with_replacement(range(n), power)
    ]
