"""The same study on a cluster: Dask's distributed scheduler as an executor."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from ..errors import CaseError

PATIENCE = 30
"""Seconds to wait for the scheduler."""
RETRIES = 3
"""Times that a member is given out again when a worker cannot even begin with it."""


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """An executor on the workers of a scheduler; they need mpmkit, and the same plug-ins.

    A worker that dies takes nothing with it: the scheduler gives its member to another, as often as its
    setting ``distributed.scheduler.allowed-failures`` says.

    Raises:
        CaseError: distributed is not installed, or there is no scheduler at the address.
    """
    try:
        from distributed import Client
    except ImportError:
        raise CaseError(
            f"--scheduler {address} needs distributed: pip install distributed, or pip install '.[cluster]' "
            "in a clone of mpmkit"
        ) from None
    try:
        # No default, or xarray would ask it for arrays, even one that never found its scheduler.
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise CaseError(f"--scheduler {address}: no scheduler answers there: {error}") from None
    try:
        yield client.get_executor(pure=False, retries=RETRIES)
    finally:
        client.close()
