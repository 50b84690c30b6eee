"""How many threads a run uses."""

from __future__ import annotations

import numba

from ..errors import CaseError

PARTICLES_PER_THREAD = 10_000
"""Below this a second thread costs more in waiting than it saves."""


def use_threads(threads: int | None, particles: int) -> int:
    """Set the number of threads: as told, or as many as the particles can keep busy. Returns it.

    Raises:
        CaseError: there cannot be so few.
    """
    if threads is not None and threads < 1:
        raise CaseError(f"threads is {threads}; it must be a whole number of at least 1")
    wanted = threads if threads is not None else max(1, particles // PARTICLES_PER_THREAD)
    chosen = min(numba.config.NUMBA_NUM_THREADS, max(1, wanted))
    numba.set_num_threads(chosen)
    return chosen
