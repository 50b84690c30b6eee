"""Checks of the environment variables for threads, and of whether this process can use threads."""

from __future__ import annotations

import os
import sys

from ..errors import CaseError, MpmkitError

COUNT, LAYER = "NUMBA_NUM_THREADS", "NUMBA_THREADING_LAYER"
"""Variables of the environment that numba reads."""


def require_sound_environment() -> None:
    """Check the environment before numba is loaded, which would fail with a message of its own.

    Raises:
        CaseError: the environment asks for threads that are impossible.
    """
    count = os.environ.get(COUNT)
    if count is not None and not (count.strip().isdecimal() and int(count) > 0):
        raise CaseError(
            f"the environment variable {COUNT} is '{count}'; it must be a whole number of at least 1"
        )
    import numba

    layer = os.environ.get(LAYER)
    if layer is not None:
        try:
            numba.get_num_threads()  # loads the layer
        except ValueError:
            raise CaseError(
                f"the environment variable {LAYER} is '{layer}', which cannot be used here; unset it, "
                "or set it to a layer that is installed, of omp, workqueue and tbb"
            ) from None


def require_threads() -> None:
    """Check that this process can use threads; call this before the first loop that may run in parallel.

    Raises:
        MpmkitError: this process was forked from a process that had run such a loop.
    """
    if _threads_lost:
        raise MpmkitError(
            "mpmkit cannot run here: this process was forked from one that had used mpmkit's threads, which "
            "do not survive a fork; start new processes, with multiprocessing.get_context('spawn')"
        )


def _after_fork() -> None:
    """GNU OpenMP ends a forked process that uses threads again, and its parent would wait for ever."""
    global _threads_lost
    import numba

    try:
        layer = numba.threading_layer()
    except ValueError:  # no loop has run in parallel yet: this process can start its own threads
        return
    _threads_lost = layer == "omp" and sys.platform.startswith("linux")


_threads_lost = False
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)
