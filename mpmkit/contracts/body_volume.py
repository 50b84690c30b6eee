"""Volume of a solid, computed from its signed distance."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..spaces import Space
from .solid import Found

COARSE = 8
"""Cells along each axis at the start."""
MOST = 60_000
"""Cells at the surface are halved until there are this many."""
COLUMNS = 4
"""Columns across each axis into which a cell at the surface is divided."""


def size_between(
    distance: Callable[[np.ndarray], Found],
    lower: np.ndarray,
    upper: np.ndarray,
    space: Space,
    *,
    around: bool = False,
) -> float:
    """Size of the part of a solid between two corners, m, ``(dim,)``; ``around``: of the full circle, m³.

    A cell whose middle is farther from the surface than its corners is full or empty; others are halved. The
    smallest ones are divided into columns along the axis nearest to the normal, of which the part behind the
    tangent plane of the surface counts. The error falls as the square of their width.

    Args:
        distance: φ, m, (k,), and its gradient at points, m, (k, dim).
        lower, upper: corners.
        space: of the scene.
        around: whether each part counts with its way around the axis, 2π r.
    """
    lower, upper = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    dim = len(lower)

    def sizes(middle: np.ndarray, side: np.ndarray) -> np.ndarray:
        area = np.full(len(middle), float(np.prod(side)))
        return 2 * np.pi * middle[:, 0] * area if around else area

    side = (upper - lower) / COARSE
    middle = lower + (np.indices((COARSE,) * dim).reshape(dim, -1).T + 0.5) * side
    halves = np.array(np.meshgrid(*[(-0.25, 0.25)] * dim, indexing="ij")).reshape(dim, -1).T
    total = 0.0
    while True:
        found, normal = distance(middle)
        reach = float(np.linalg.norm(side)) / 2
        total += float(sizes(middle[found <= -reach], side).sum())
        cut = np.abs(found) < reach
        middle, found, normal = middle[cut], found[cut], normal[cut]
        if not 0 < len(middle) << dim <= MOST:
            break
        middle, side = (middle[:, None] + halves * side).reshape(-1, dim), side / 2
    return total + _cut(distance, middle, side, normal, sizes)


def _cut(
    distance: Callable[[np.ndarray], Found],
    middle: np.ndarray,
    side: np.ndarray,
    normal: np.ndarray,
    sizes: Callable[[np.ndarray, np.ndarray], np.ndarray],
) -> float:
    """Size of the filled parts of cells at the surface, by columns along the axis nearest to the normal."""
    dim, total = len(side), 0.0
    offsets = (np.arange(COLUMNS) + 0.5) / COLUMNS - 0.5
    for axis in range(dim):
        cells = middle[np.argmax(np.abs(normal), axis=1) == axis]
        along = np.arange(dim) == axis
        column = np.where(along, side, side / COLUMNS)
        for place in np.array(np.meshgrid(*[offsets] * (dim - 1), indexing="ij")).reshape(dim - 1, -1).T:
            at = cells + np.insert(place, axis, 0.0) * side
            found, n = distance(at)
            # Behind the tangent plane: x n_axis ≤ -φ, with x between the ends of the column.
            filled = np.clip(0.5 - found / (np.maximum(np.abs(n[:, axis]), 1e-9) * side[axis]), 0.0, 1.0)
            shift = -np.sign(n[:, axis]) * (1 - filled) / 2 * side[axis]
            total += float(filled @ sizes(at + shift[:, None] * along, column))
    return total
