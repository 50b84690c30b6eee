"""The same study on a cluster: Dask's distributed scheduler as an executor."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from ..errors import CaseError
from .execute import Unfinished

PATIENCE = 5
"""Seconds to wait for the scheduler, which is there already or is not."""
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

    class Connection(Client):
        def __del__(self) -> None:
            """Wait for nothing: one that is interrupted while it connects cannot be closed; others are."""

    with _silent("distributed", "distributed.client"):
        try:
            # No default, or xarray would ask it for arrays, even one that never found its scheduler.
            client = Connection(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise CaseError(f"--scheduler {address}: no scheduler answers there: {error}") from None
        try:
            yield client.get_executor(pure=False, retries=RETRIES)
        except Unfinished as error:
            raise Unfinished(f"the scheduler {address} does not answer any more: {error}") from None
        finally:
            client.close()


@contextmanager
def _silent(*names: str) -> Iterator[None]:
    """Keep the tracebacks of loggers off the screen: what has to be said is said in a sentence."""
    loggers = {logging.getLogger(name): logging.getLogger(name).level for name in names}
    try:
        for logger in loggers:
            logger.setLevel(logging.CRITICAL)
        yield
    finally:
        for logger, level in loggers.items():
            logger.setLevel(level)
