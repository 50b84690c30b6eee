"""The same study on a cluster: Dask's distributed scheduler as an executor."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from ..errors import CaseError
from .execute import Unfinished

PATIENCE = 5
"""Seconds to wait for the scheduler, which must already run."""
RETRIES = 3
"""How often a member is sent again if a worker cannot start it."""


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """An executor on the workers of a scheduler; they need mpmkit, and the same plug-ins.

    If a worker dies, no result is lost: the scheduler gives its member to another worker, up to
    ``distributed.scheduler.allowed-failures`` times.

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
            """Close the client without waiting. A client interrupted while connecting cannot be closed."""

    with _silent("distributed", "distributed.client"):
        try:
            # Not the default client: xarray would otherwise use it for arrays, even without a scheduler.
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
    """Keep tracebacks of loggers off the screen: mpmkit reports the problem in one sentence."""
    loggers = {logging.getLogger(name): logging.getLogger(name).level for name in names}
    try:
        for logger in loggers:
            logger.setLevel(logging.CRITICAL)
        yield
    finally:
        for logger, level in loggers.items():
            logger.setLevel(level)
