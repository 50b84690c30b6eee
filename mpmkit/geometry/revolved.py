"""Volume of a part of a body of revolution, cut off by planes along the axes of the grid."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from ..spaces import Space

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)


def part_of_revolved(
    radius: Callable[[np.ndarray], np.ndarray],
    heights: Callable[[float], Sequence[float]],
    middle: Sequence[float],
    lower: np.ndarray,
    upper: np.ndarray,
    space: Space,
) -> float:
    """V = ∫ A(z) dz, m³: A is the part of the section of radius R(z) that is between ``lower`` and ``upper``.

    In 3-D the section is a disc, in plane strain a line (1 m thick), in an axisymmetric scene a ring. A(z) is
    smooth between the heights where the circle reaches a cut or the corner of two; there it goes like
    (z − z₀)^(1/2) or smoother, so that Gauss-Legendre quadrature in t, z = z₀ + h (3t² − 2t³), is exact to
    about 1e-10.

    Args:
        radius: R(z), m.
        heights: z at which R(z) has a given value, m.
        middle: where the axis of the body is, m, (dim - 1,).
        lower: lower corner of the part, m, (dim,).
        upper: upper corner, m, (dim,).
        space: the space of the scene.
    """
    *low, bottom = lower
    *high, top = upper
    offsets = [[abs(a - c), abs(b - c)] for a, b, c in zip(low, high, middle, strict=True)]
    reached = [r for pair in offsets for r in pair]
    if space.dim == 3:
        reached += [math.hypot(x, y) for x in offsets[0] for y in offsets[1]]
    breaks = sorted({bottom, top, *(z for r in reached for z in heights(r) if bottom < z < top)})
    total = 0.0
    for start, end in pairwise(breaks):
        t = (_NODES + 1) / 2
        z = start + (end - start) * t * t * (3 - 2 * t)
        weight = _WEIGHTS * 3 * t * (1 - t) * (end - start)
        total += float(weight @ _section(radius(z), low, high, middle, space))
    return total


def _section(
    radius: np.ndarray, low: list[float], high: list[float], middle: Sequence[float], space: Space
) -> np.ndarray:
    if space.radial:
        return math.pi * (np.minimum(radius, high[0]) ** 2 - np.minimum(radius, low[0]) ** 2)
    if space.dim == 2:
        ends = np.clip([low[0] - middle[0], high[0] - middle[0]], -radius[:, None], radius[:, None])
        return ends[:, 1] - ends[:, 0]
    (x0, y0), (x1, y1) = np.subtract(low, middle), np.subtract(high, middle)
    return (
        _corner(radius, x1, y1) - _corner(radius, x0, y1) - _corner(radius, x1, y0) + _corner(radius, x0, y0)
    )


def _corner(radius: np.ndarray, x: float, y: float) -> np.ndarray:
    """Area of a disc's part with X ≤ x and Y ≤ y, m², (n,); the centre of the disc is at 0."""
    disc, left, below = math.pi * radius**2, _segment(radius, x), _segment(radius, y)
    outside = np.maximum(left + below - disc, 0.0) if x >= 0 and y >= 0 else np.minimum(left, below)
    if x < 0 and y < 0:
        outside = np.zeros_like(radius)
    return np.where(x * x + y * y >= radius**2, outside, (left + below) / 2 - disc / 4 + x * y)


def _segment(radius: np.ndarray, x: float) -> np.ndarray:
    """Area of a disc's part with X ≤ x, m², (n,)."""
    x = np.clip(x, -radius, radius)
    return (
        radius**2 * (math.pi / 2)
        + radius**2 * np.arcsin(x / np.maximum(radius, 1e-300))
        + x * np.sqrt(np.maximum(radius**2 - x**2, 0.0))
    )
