"""Looks at the tables of shape functions: where they lead, and whether they sum to what they must."""

from __future__ import annotations

import math

from numba import prange

from .compile import CHUNK, chunk_count, function, kernel


@kernel()
def first_astray(position, inverse_cell, base, support, close, lowest, highest, firsts):
    """First particle whose nodes are more than a cell from its own, or are not stored; -1 without one.

    Args:
        base: ``(n, dim)`` first node along each axis, of ``support`` nodes.
        close: cells by which a position may be rounded.
        lowest, highest: ``(dim,)`` first and last node that are stored.
        firsts: scratch, an integer a chunk.
    """
    n, dim = position.shape
    chunks = chunk_count(n)
    for c in prange(chunks):
        first = -1
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            good = True
            for d in range(dim):
                cells = position[p, d] * inverse_cell
                low, high = base[p, d], base[p, d] + support - 1
                good &= (low >= math.floor(cells - close) - 1) & (high <= math.floor(cells + close) + 2)
                good &= (low >= lowest[d]) & (high <= highest[d])
            if not good and first < 0:
                first = p
        firsts[c] = first
    return _first(firsts, chunks)


@kernel()
def first_untrue(weight, gradient, cell_size, close, firsts):
    """First particle whose weights along an axis do not sum to one, or gradients to zero; -1 without one.

    A sum that is not a number is wrong as well. ``firsts`` is scratch, an integer a chunk.
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
    return _first(firsts, chunks)


@function()
def _first(firsts, chunks):
    for c in range(chunks):
        if firsts[c] >= 0:
            return firsts[c]
    return -1
