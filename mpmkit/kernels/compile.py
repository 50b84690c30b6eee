"""How kernels are compiled, in one place.

Loops run in parallel over *chunks* of fixed length instead of over particles, so that a particle meets the
same instructions whatever the number of threads: results are equal to the bit.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numba

from .code_cache import cached_code
from .collector import rest_while_compiling

# A thread of GNU OpenMP that waits for another one spins for milliseconds before it sleeps; where the two
# have come to share a core, that is what each loop then takes. This many turns are some tens of microseconds.
# It is read when the first loop runs in parallel, and what the user has set stays.
os.environ.setdefault("GOMP_SPINCOUNT", "2000")

rest_while_compiling()

CHUNK = 256
"""Particles in a chunk: enough to hide the cost of scheduling, few enough to keep threads evenly busy."""

# No fastmath: it breaks isfinite, and code just compiled could round otherwise than code that was kept.
_OPTIONS: dict[str, Any] = {"error_model": "numpy"}


def kernel() -> Callable[[Callable], Callable]:
    """Decorator of a loop over all particles or nodes, with ``prange`` over chunks."""
    return cached_code(numba.njit, parallel=True, **_OPTIONS)


def function() -> Callable[[Callable], Callable]:
    """Decorator of a function that kernels call, or that calls kernels."""
    return cached_code(numba.njit, **_OPTIONS)


def inline() -> Callable[[Callable], Callable]:
    """Decorator of a small function that becomes part of the kernel that calls it.

    LLVM puts it there: numba's own ``inline="always"`` copies the source into each caller, and finds the
    types of each copy anew, which takes a fifth longer to compile.
    """
    return cached_code(numba.njit, forceinline=True, **_OPTIONS)


@function()
def chunk_count(n: int) -> int:
    """Chunks that n particles make."""
    return (n + CHUNK - 1) // CHUNK
