"""Quadratic B-splines on a lattice, the parts of boxes in its cells, and the slopes of nodal fields."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, function, inline, kernel
from .vectors import lane, load_twice, plus, zero

SUPPORT, PARTS = 3, 2
"""Nodes along an axis that a spline touches, and cells that a box at most one cell wide touches."""


@inline()
def spline(x):
    """First of the three nodes that the spline at a place touches, the three weights, and the distance of the
    place from the middle node, -1/2 to 1/2. Places and distances are in spacings of the lattice.
    """
    first = math.floor(x - 0.5)
    d = x - first - 1
    return first, 0.5 * (0.5 - d) ** 2, 0.75 - d * d, 0.5 * (0.5 + d) ** 2, d


@kernel()
def fill_splines(x, inverse, base, weight):
    """Weights ``(n, dim, 3)`` of the quadratic B-spline: a hat function averaged over one spacing.

    ``inverse`` is 1 / spacing, 1/m; node ``base + a`` lies at ``(base + a) / inverse``.
    """
    n, dim = x.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            for a in range(dim):
                base[p, a], weight[p, a, 0], weight[p, a, 1], weight[p, a, 2], _ = spline(x[p, a] * inverse)


@kernel()
def fill_parts(x, half_size, inverse, base, part):
    """Part ``(n, dim, 2)`` of each box in cell ``base`` and the next one; boxes are at most a cell wide."""
    n, dim = x.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            for a in range(dim):
                half = min(half_size[p, a] * inverse, 0.5)
                begin = x[p, a] * inverse - half
                first = math.floor(begin)
                beyond = max(0.0, begin + 2 * half - first - 1) / (2 * half)
                base[p, a] = first
                part[p, a, 0] = 1 - beyond
                part[p, a, 1] = beyond


@inline()
def _change(off, a):
    """Derivative of weight a, over that of the place in spacings; ``off``: distance from the middle node."""
    return off - 0.5 if a == 0 else -2 * off if a == 1 else off + 0.5


@inline()
def _along_row(first, second, third, row):
    return first * lane(row, 0) + second * lane(row, 1) + third * lane(row, 2)


@cache
def gather_slope(dim: int):
    """The kernel that takes Σ ∇N value of a nodal field to the particles, into ``slope (n, dim)``, 1/m.

    The distance d from the middle node, in spacings, is the difference of the outer weights. So the slopes of
    the splines need no table; they are d - 1/2, -2 d and d + 1/2, divided by the spacing. Rows are read as
    four doubles: ``field`` must have one more of them behind it than nodes.
    """
    last = dim - 1

    @kernel()
    def gather_slope(field, strides, lower, base, weight, inverse, slope):
        n = len(base)
        plane, line, low0, low1, low2 = strides[0], strides[1], lower[0], lower[1], lower[last]
        for chunk in prange(chunk_count(n)):
            for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
                first = (base[p, 0] - low0) * plane + (base[p, last] - low2)
                off0, off2 = weight[p, 0, 2] - weight[p, 0, 0], weight[p, last, 2] - weight[p, last, 0]
                value = of_0 = of_1 = zero()
                if dim == 2:
                    for a in range(SUPPORT):
                        row = load_twice(field, first + a * plane)
                        value = plus(value, weight[p, 0, a], row)
                        of_0 = plus(of_0, _change(off0, a), row)
                else:
                    first += (base[p, 1] - low1) * line
                    off1 = weight[p, 1, 2] - weight[p, 1, 0]
                    for a in range(SUPPORT):
                        of_plane = change = zero()
                        for b in range(SUPPORT):
                            row = load_twice(field, first + a * plane + b * line)
                            of_plane = plus(of_plane, weight[p, 1, b], row)
                            change = plus(change, _change(off1, b), row)
                        value = plus(value, weight[p, 0, a], of_plane)
                        of_0 = plus(of_0, _change(off0, a), of_plane)
                        of_1 = plus(of_1, weight[p, 0, a], change)
                w0, w1, w2 = weight[p, last, 0], weight[p, last, 1], weight[p, last, 2]
                slope[p, 0] = inverse * _along_row(w0, w1, w2, of_0)
                if dim == 3:
                    slope[p, 1] = inverse * _along_row(w0, w1, w2, of_1)
                slope[p, last] = inverse * _along_row(
                    _change(off2, 0), _change(off2, 1), _change(off2, 2), value
                )

    return gather_slope


@cache
def add_sizes(dim: int):
    """The function that adds Σ size N of particles in any order to ``sums (nodes,)``.

    It uses no table of weights, so that it takes no memory, but is slower than ``scatter_pairs``. Use it for
    what is needed only rarely.
    """
    along, planes = dim - 1, SUPPORT if dim == 3 else 1

    @function()
    def add_sizes(x, size, inverse, lower, strides, sums):
        weight = np.ones((3, SUPPORT))
        for p in range(len(x)):
            first = 0
            for a in range(dim):
                base, weight[a, 0], weight[a, 1], weight[a, 2], _ = spline(x[p, a] * inverse)
                first += (base - lower[a]) * strides[a]
            for i in range(SUPPORT):
                for j in range(planes):
                    w = size[p] * weight[0, i] * (weight[1, j] if dim == 3 else 1.0)
                    row = first + i * strides[0] + j * strides[1]
                    for k in range(SUPPORT):
                        sums[row + k] += w * weight[along, k]

    return add_sizes


def below_surface(distance: np.ndarray) -> np.ndarray:
    """Crowding of a node ``distance`` cells below the flat surface of a deep body: ∫ N from -∞."""
    d = np.abs(distance)
    inner = 0.75 * d - d**3 / 3
    outer = 0.5 - (1.5 - np.minimum(d, 1.5)) ** 3 / 6
    return 0.5 + np.sign(distance) * np.where(d < 0.5, inner, outer)
