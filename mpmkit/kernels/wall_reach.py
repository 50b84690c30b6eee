"""Particles near a wall at any place and angle: their distance, and the nodes at which they touch it."""

from __future__ import annotations

import numpy as np

from .compile import function, inline

NEAR = 2.8
"""If the box of a particle can reach a wall, the nodes of its cell are within this many cells of the wall."""
TOUCH = 0.02
"""Largest gap, in cells, between a box and a wall that touch."""


@function()
def _distance(x, inverse, lower, strides, distance, slope):
    """Distance of a place from the wall, in cells, interpolated in its cell, and its slopes (out)."""
    dim = len(x)
    first = 0
    for a in range(dim):
        first += (int(np.floor(x[a] * inverse)) - lower[a]) * strides[a]
    d = 0.0
    slope[:] = 0.0
    for k in range(1 << dim):
        at, w = first, 1.0
        for a in range(dim):
            part = x[a] * inverse - np.floor(x[a] * inverse)
            at += (k >> a & 1) * strides[a]
            w *= part if k >> a & 1 else 1.0 - part
        d += w * distance[at]
        for a in range(dim):
            s = distance[at] if k >> a & 1 else -distance[at]
            for e in range(dim):
                if e != a:
                    part = x[e] * inverse - np.floor(x[e] * inverse)
                    s *= part if k >> e & 1 else 1.0 - part
            slope[a] += s
    return d


@inline()
def _is_near(position, p, inverse, lower, strides, distance):
    """Whether particle p is in a cell near the wall, by the first node of the cell."""
    first = 0
    for a in range(position.shape[1]):
        first += (int(position[p, a] * inverse) - lower[a]) * strides[a]
    return distance[first] < NEAR


@function()
def keep_out(position, cell_size, lower, strides, distance):
    """Move particles that have entered the wall back to its surface along the normal; return their number."""
    inverse, count = 1 / cell_size, 0
    slope = np.empty(position.shape[1])
    for p in range(len(position)):
        if not _is_near(position, p, inverse, lower, strides, distance):
            continue
        d = _distance(position[p], inverse, lower, strides, distance, slope)
        if d < 0.0:
            square = (slope * slope).sum()
            if square > 0.25:  # in the middle of a thin wall neither side is nearer
                for a in range(len(slope)):
                    position[p, a] -= d * slope[a] / square * cell_size
                count += 1
    return count


@function()
def mark_touched(position, half_size, inverse, base, weight, lower, strides, distance, touched):
    """Mark the nodes of the particles whose boxes reach the wall; return the number of these particles.

    Args:
        distance: (nodes,) distance of the nodes of the window, in cells; ``FAR`` if they are not near the
            wall.
        touched: (nodes,) uint8 (out).
    """
    n, dim = position.shape
    support = weight.shape[2]
    planes = support if dim == 3 else 1
    count = 0
    slope = np.empty(dim)
    for p in range(n):
        if not _is_near(position, p, inverse, lower, strides, distance):
            continue
        d = _distance(position[p], inverse, lower, strides, distance, slope)
        reach = TOUCH
        for a in range(dim):
            reach += half_size[p, a] * inverse * abs(slope[a])
        if not d <= reach:
            continue
        count += 1
        first = 0
        for a in range(dim):
            first += (base[p, a] - lower[a]) * strides[a]
        for i in range(support):
            for j in range(planes):
                row = first + i * strides[0] + j * strides[1] * (dim - 2)
                w = weight[p, 0, i] * (weight[p, 1, j] if dim == 3 else 1.0)
                for k in range(support):
                    if w * weight[p, dim - 1, k] > 0.0:
                        touched[row + k] = 1
    return count
