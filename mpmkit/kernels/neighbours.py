"""The least of a node or cell and its neighbours, on a block (ni, nj, nk), with nj = 1 in two dimensions."""

from __future__ import annotations

from numba import prange

from .compile import kernel


@kernel()
def least_around(values, least):
    """Least of each and all its neighbours, corners included; what is beyond the block counts 0."""
    ni, nj, nk = values.shape
    beside = 1 if nj > 1 else 0
    for i in prange(ni):
        for j in range(nj):
            for k in range(nk):
                edge = i == 0 or i == ni - 1 or k == 0 or k == nk - 1
                if nj > 1:
                    edge |= j == 0 or j == nj - 1
                low = min(values[i, j, k], 0.0) if edge else values[i, j, k]
                for a in range(max(0, i - 1), min(ni, i + 2)):
                    for b in range(max(0, j - beside), min(nj, j + beside + 1)):
                        for c in range(max(0, k - 1), min(nk, k + 2)):
                            low = min(low, values[a, b, c])
                least[i, j, k] = low


@kernel()
def least_beside(values, least):
    """Least of each and those that share a face with it; what is beyond the block does not count."""
    ni, nj, nk = values.shape
    for i in prange(ni):
        for j in range(nj):
            for k in range(nk):
                low = values[i, j, k]
                for a in (max(0, i - 1), min(ni - 1, i + 1)):
                    low = min(low, values[a, j, k])
                for b in (max(0, j - 1), min(nj - 1, j + 1)):
                    low = min(low, values[i, b, k])
                for c in (max(0, k - 1), min(nk - 1, k + 1)):
                    low = min(low, values[i, j, c])
                least[i, j, k] = low
