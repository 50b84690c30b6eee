"""How kernels are compiled, in one place.

Loops run in parallel over *chunks* of fixed length instead of over particles, so that a particle meets the
same instructions whatever the number of threads: results are equal to the bit.
"""

from __future__ import annotations

from functools import partial

import numba

CHUNK = 256
"""Particles in a chunk: enough to hide the cost of scheduling, few enough to keep threads evenly busy."""

# Contraction to fused multiply-adds is safe; full fastmath is not, it breaks isfinite.
kernel = partial(numba.njit, cache=True, parallel=True, error_model="numpy", fastmath={"contract"})
inline = partial(numba.njit, cache=True, inline="always", error_model="numpy", fastmath={"contract"})


@numba.njit(cache=True)
def chunk_count(n: int) -> int:
    """Chunks that n particles make."""
    return (n + CHUNK - 1) // CHUNK
