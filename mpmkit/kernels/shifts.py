"""Shifts particles, and finds their velocity at the new places."""

from __future__ import annotations

from numba import prange

from .compile import CHUNK, chunk_count, kernel


@kernel()
def shift(position, displacement, low, high, affine, change):
    """x ← min(max(x + δx, low), high), and the change C δx of the velocity by its affine part C, 1/s.

    A particle whose displacement is 0 keeps its position to the bit, also beyond ``low`` or ``high``.

    Args:
        position, displacement: ``(n, dim)``, m.
        low, high: ``(dim,)``, m.
        affine: ``(n, dim, dim)``, 1/s; no columns if there is no affine part.
        change: ``(n, dim)``, m/s, becomes the change of the velocity if there is an affine part.
    """
    n, dim = position.shape
    has_affine = affine.shape[1] > 0
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            if has_affine:
                for i in range(dim):
                    change[p, i] = 0.0
            for d in range(dim):
                if displacement[p, d] != 0.0:
                    before = position[p, d]
                    position[p, d] = min(max(before + displacement[p, d], low[d]), high[d])
                    if has_affine:
                        for i in range(dim):
                            change[p, i] += affine[p, i, d] * (position[p, d] - before)
