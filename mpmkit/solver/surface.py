"""Position of the free surface, from the crowding of the nodes."""

from __future__ import annotations

import math

import numpy as np

from ..kernels.splines import below_surface
from .crowding import Crowding

SOLID = 0.9
"""A column of nodes gives a surface only if its largest crowding is at least this."""
STEPS = np.linspace(-1.5, 1.5, 601)


def mean_top(found: Crowding, centre: np.ndarray, radial: bool) -> float:
    """Mean height of the surface within a cell of a vertical line, m above the lower face.

    The crowding of a node that is d cells below a flat surface is ∫ N from -∞ to d, with its B-spline N. Of
    the two nodes between which the crowding falls below 1/2, the one closer to 1/2 gives d. A single
    particle on top of the others has little influence, and gaps between boxes do not lower the surface.

    Args:
        found: of the scene.
        centre: ``(dim - 1,)``, m, where the line is, from the grid's lower corner.
        radial: whether the line is the axis of an axisymmetric scene, where nodes count with their rings.

    Returns:
        NaN if the material is thinner or narrower than a cell.
    """
    block = found.block
    dx, flat = block.spacing, len(centre)
    places = [dx * (np.arange(n) + low) for n, low in zip(block.shape, block.lower, strict=True)]
    mine = block.own().reshape(block.shape)
    weight = (block.room * block.own()).reshape(block.shape)
    for axis in range(flat):
        near = np.abs(places[axis] - centre[axis]) <= dx * (1 + 1e-9)
        if radial:  # a ring; at the axis a disc of half a cell
            near = near * np.maximum(places[axis], dx / 4)
        weight = weight * near.reshape([-1 if a == axis else 1 for a in range(flat + 1)])
    across = tuple(range(flat))
    total = weight.sum(axis=across)
    values = (weight * found.values.reshape(block.shape)).sum(axis=across)
    column = np.divide(values, total, out=np.zeros_like(values), where=total > 0)
    rows = np.flatnonzero(mine.any(axis=across) & (column >= 0.5))
    if not len(rows) or column.max() < SOLID:
        return math.nan
    last = int(rows[-1])
    beyond = column[last + 1] if last + 1 < len(column) else 0.0
    node = last if column[last] - 0.5 <= 0.5 - beyond else last + 1
    depth = float(np.interp(column[node], below_surface(STEPS), STEPS))
    return float(places[flat][last] + dx * (depth + node - last))
