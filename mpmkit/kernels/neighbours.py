"""Smallest value of a node or cell and its neighbours, on a block (ni, nj, nk), with nj = 1 in 2-D."""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import kernel


def least_around(values, least):
    """Smallest value of each and all its neighbours, corners included; beyond the block the value is 0."""
    least[...] = values
    for axis in _axes(values):  # the minimum of rows, then of planes, then of blocks
        _along(_split(least.copy(), axis), 0.0, _split(least, axis))


def least_beside(values, least):
    """Smallest value of each and those that share a face with it; nothing beyond the block counts."""
    least[...] = values
    for axis in _axes(values):
        _along(_split(values, axis), np.inf, _split(least, axis))


def _axes(values):
    return (0, 1, 2) if values.shape[1] > 1 else (0, 2)


def _split(values, axis):
    """Reshape to (before, n, behind): the axes before an axis become one axis, and those behind it too."""
    return values.reshape(int(np.prod(values.shape[:axis])), values.shape[axis], -1)


@kernel()
def _along(values, beyond, least):
    """Smallest of ``least``, and of the two values beside each along the middle axis."""
    before, n, behind = values.shape
    for row in prange(before * n):
        i, j = row // n, row % n
        for k in range(behind):
            lower = values[i, j - 1, k] if j > 0 else beyond
            upper = values[i, j + 1, k] if j < n - 1 else beyond
            least[i, j, k] = min(least[i, j, k], lower, upper)
