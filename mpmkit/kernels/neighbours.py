"""The least of a node or cell and its neighbours, on a block (ni, nj, nk), with nj = 1 in two dimensions."""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import kernel


def least_around(values, least):
    """Least of each and all its neighbours, corners included; what is beyond the block counts 0."""
    least[...] = values
    for axis in _axes(values):  # the least of rows, then of planes, then of blocks
        _along(_split(least.copy(), axis), 0.0, _split(least, axis))


def least_beside(values, least):
    """Least of each and those that share a face with it; what is beyond the block does not count."""
    least[...] = values
    for axis in _axes(values):
        _along(_split(values, axis), np.inf, _split(least, axis))


def _axes(values):
    return (0, 1, 2) if values.shape[1] > 1 else (0, 2)


def _split(values, axis):
    """(before, n, behind): all that lies before an axis as one axis, and all that lies behind it."""
    return values.reshape(int(np.prod(values.shape[:axis])), values.shape[axis], -1)


@kernel()
def _along(values, beyond, least):
    """The least of what is there and of the two beside it along the axis in the middle."""
    before, n, behind = values.shape
    for row in prange(before * n):
        i, j = row // n, row % n
        for k in range(behind):
            lower = values[i, j - 1, k] if j > 0 else beyond
            upper = values[i, j + 1, k] if j < n - 1 else beyond
            least[i, j, k] = min(least[i, j, k], lower, upper)
