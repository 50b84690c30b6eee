"""Sums over all particles, chunk by chunk: equal to the bit for any number of threads."""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, function, kernel

_ONE = np.ones(1)


@function()
def _in_order(parts):
    """Σ parts, in order. In a kernel ``parts.sum()`` would depend on the number of threads."""
    total = 0.0
    for part in parts:
        total += part
    return total


@kernel()
def moment(mass, vectors, along):
    """Σ m v·a, with m ``(n,)``, v ``(n, dim)`` and the direction a ``(dim,)``."""
    n, dim = vectors.shape
    chunks = chunk_count(n)
    parts = np.zeros(chunks)
    for c in prange(chunks):
        part = 0.0
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            component = 0.0
            for d in range(dim):
                component += vectors[p, d] * along[d]
            part += mass[p] * component
        parts[c] = part
    return _in_order(parts)


def product(a, b):
    """Σ a b, for two arrays ``(n,)``."""
    return moment(a, b[:, None], _ONE)


@kernel()
def kinetics(mass, velocity):
    """Σ m, Σ m v² and the largest v², with m ``(n,)`` and v ``(n, dim)``."""
    n, dim = velocity.shape
    chunks = chunk_count(n)
    parts = np.zeros((chunks, 3))
    for c in prange(chunks):
        of_mass = of_square = largest = 0.0
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            square = 0.0
            for d in range(dim):
                square += velocity[p, d] ** 2
            of_mass += mass[p]
            of_square += mass[p] * square
            largest = max(largest, square)
        parts[c, 0], parts[c, 1], parts[c, 2] = of_mass, of_square, largest
    largest = 0.0
    for c in range(chunks):
        largest = max(largest, parts[c, 2])
    return _in_order(parts[:, 0]), _in_order(parts[:, 1]), largest
