"""How many threads a run uses."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager

import numba

from ..errors import CaseError

LOGGER = logging.getLogger("mpmkit")
PARTICLES_PER_THREAD = 10_000
"""With fewer particles, a second thread costs more waiting time than it saves."""


def possible_threads(threads: int | None) -> int | None:
    """The requested number of threads, or the largest possible one with a warning.

    Raises:
        CaseError: the number is below 1.
    """
    if threads is None:
        return None
    if threads < 1:
        raise CaseError(f"threads is {threads}; it must be a whole number of at least 1")
    most = numba.config.NUMBA_NUM_THREADS
    if threads > most:
        LOGGER.warning("threads is %d, but only %d can be used here; the run uses %d", threads, most, most)
    return min(threads, most)


@contextmanager
def using_threads(threads: int | None, particles: int) -> Iterator[int]:
    """Inside the block numba uses as many threads as asked for, or as the particles can keep busy.

    Yields that number; after the block, the old number is restored.

    Raises:
        CaseError: the number is below 1.
    """
    asked = possible_threads(threads)
    before = numba.get_num_threads()
    chosen = asked or min(numba.config.NUMBA_NUM_THREADS, max(1, particles // PARTICLES_PER_THREAD))
    numba.set_num_threads(chosen)
    try:
        yield chosen
    finally:
        numba.set_num_threads(before)
