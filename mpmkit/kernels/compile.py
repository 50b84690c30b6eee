"""How kernels are compiled, in one place.

Loops run in parallel over *chunks* of fixed length instead of over particles. So the same instructions are
applied to a particle for any number of threads, and the results are equal to the bit.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numba

from .code_cache import cached_code
from .collector import rest_while_compiling

# A thread of GNU OpenMP that waits for another one spins for milliseconds before it sleeps. If both share a
# core, each loop then takes milliseconds. This number of spins takes some tens of microseconds. OpenMP reads
# it when the first loop runs in parallel. A value set by the user is kept.
os.environ.setdefault("GOMP_SPINCOUNT", "2000")

rest_while_compiling()

CHUNK = 256
"""Particles in a chunk: enough to hide the cost of scheduling, few enough to keep threads evenly busy."""

# No fastmath: it breaks isfinite, and new code could round differently from code in the cache.
_OPTIONS: dict[str, Any] = {"error_model": "numpy"}


def kernel() -> Callable[[Callable], Callable]:
    """Decorator of a loop over all particles or nodes, with ``prange`` over chunks."""
    return cached_code(numba.njit, parallel=True, **_OPTIONS)


def function() -> Callable[[Callable], Callable]:
    """Decorator of a function that kernels call, or that calls kernels."""
    return cached_code(numba.njit, **_OPTIONS)


def inline() -> Callable[[Callable], Callable]:
    """Decorator of a small function that becomes part of the kernel that calls it.

    LLVM inlines it. numba's own ``inline="always"`` would copy the source into each caller and infer the
    types of each copy again, which takes a fifth longer to compile.
    """
    return cached_code(numba.njit, forceinline=True, **_OPTIONS)


@function()
def chunk_count(n: int) -> int:
    """Number of chunks of n particles."""
    return (n + CHUNK - 1) // CHUNK
