"""Checks of the tables of shape functions: their nodes are near the particles, and their sums are right."""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, function, kernel


@function()
def near(position, inverse_cell, base, least, most):
    """Whether ``least <= base - position / cell <= most`` for all entries of two arrays, ``(n, dim)``."""
    good, places, nodes = True, position.reshape(-1), base.reshape(-1)
    for k in range(len(nodes)):
        away = nodes[k] - places[k] * inverse_cell
        good &= (away >= least) & (away <= most)
    return good


@kernel()
def near_in_parallel(position, inverse_cell, base, least, most):
    """``near``, in parallel over chunks."""
    n = len(base)
    far = np.zeros(chunk_count(n), dtype=np.bool_)
    for c in prange(len(far)):
        part = slice(c * CHUNK, min(n, (c + 1) * CHUNK))
        far[c] = not near(position[part], inverse_cell, base[part], least, most)
    return not far.any()


@kernel()
def first_untrue(weight, gradient, cell_size, close, firsts):
    """First particle whose weights along an axis do not sum to one, or gradients to zero; -1 without one.

    A sum that is not a number is wrong too. ``firsts`` is scratch, an integer for each chunk.
    """
    n, dim, support = weight.shape
    chunks = chunk_count(n)
    for c in prange(chunks):
        first = -1
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            good = True
            for d in range(dim):
                whole, none = -1.0, 0.0
                for a in range(support):
                    whole += weight[p, d, a]
                    none += gradient[p, d, a]
                good &= (abs(whole) <= close) & (abs(none) * cell_size <= close)
            if not good and first < 0:
                first = p
        firsts[c] = first
    for c in range(chunks):
        if firsts[c] >= 0:
            return firsts[c]
    return -1
