"""Finds the nearest neighbours among particles."""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import kernel


@kernel()
def nearest_partners(first, position, kind, size, largest, partner, square):
    """The nearest particle of the same cell and kind, if the sum of both sizes is at most ``largest``.

    Args:
        first: ``(cells + 1,)``, where each cell begins in the other arrays.
        position: ``(n, dim)``.
        kind: ``(n,)`` integers.
        size: ``(n,)``.
        largest: largest sum of two sizes.
        partner: ``(n,)``, becomes the index of the nearest particle, the first of several at equal distance;
            -1 if there is none.
        square: ``(n,)``, becomes the square of its distance.
    """
    dim = position.shape[1]
    for c in prange(len(first) - 1):
        for p in range(first[c], first[c + 1]):
            partner[p], square[p] = -1, np.inf
            for q in range(first[c], first[c + 1]):
                if q == p or kind[q] != kind[p] or size[q] + size[p] > largest:
                    continue
                apart = 0.0
                for axis in range(dim):
                    apart += (position[q, axis] - position[p, axis]) ** 2
                if apart < square[p]:
                    partner[p], square[p] = q, apart
