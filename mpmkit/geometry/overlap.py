"""Overlap of two bodies."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from ..contracts.body_shape import BodyShape
from ..spaces import Space

NEGLIGIBLE = 1e-5
"""Allowed overlap relative to the larger extent; it exceeds rounding of meshes in single precision."""

_POINTS = 1 << 17
"""Most points at which two shapes are compared."""


def shared_volume(
    first: BodyShape,
    second: BodyShape,
    space: Space,
    spacing: Sequence[float] | np.ndarray,
    within: tuple[np.ndarray, np.ndarray],
) -> float:
    """Volume, m³, that two shapes share; 0 if they only touch.

    It is exact for boxes. Other shapes are compared at points a quarter of a particle apart, or farther in a
    large region; an overlap between the points is not detected.

    Args:
        first: a shape.
        second: the other.
        space: the space of the scene.
        spacing: of the particles, m, (dim,).
        within: lower and upper corner, m, of the region that counts.
    """
    bounds = [first.bounds(space), second.bounds(space)]
    margin = NEGLIGIBLE * max(float((upper - lower).max()) for lower, upper in bounds)
    lower = np.max([within[0], bounds[0][0], bounds[1][0]], axis=0)
    upper = np.min([within[1], bounds[0][1], bounds[1][1]], axis=0)
    if (upper - lower <= margin).any():
        return 0.0
    if _fills(first, bounds[0], space) and _fills(second, bounds[1], space):
        return first.part(lower, upper, space)
    points, size = _points(lower, upper, np.asarray(spacing, dtype=float) / 4)
    for shape in (first, second):
        points = points[shape.contains(points, space)]
    # Within the margin of a surface, a point may be on both of two shapes that only touch.
    steps = margin * np.array(list(product((-1, 1), repeat=space.dim)))
    for shape, step in product((first, second), steps):
        points = points[shape.contains(points + step, space)]
    return float(space.particle_volume(points, size).sum())


def _fills(shape: BodyShape, bounds: tuple[np.ndarray, np.ndarray], space: Space) -> bool:
    """Whether a shape fills the box around it."""
    lower, upper = bounds
    whole = float(space.particle_volume((lower + upper)[None] / 2, upper - lower)[0])
    return abs(shape.volume(space) - whole) <= 1e-12 * whole


def _points(lower: np.ndarray, upper: np.ndarray, spacing: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centres (n, dim) of the equal boxes that divide a region, and their side lengths (dim,), m."""
    wanted = np.maximum((upper - lower) / spacing, 1.0)
    coarser = max(1.0, float(np.prod(wanted)) / _POINTS) ** (1 / len(wanted))
    count = np.maximum(np.ceil(wanted / coarser), 4).astype(np.int64)
    size = (upper - lower) / count
    return lower + (np.indices(count).reshape(len(count), -1).T + 0.5) * size, size
