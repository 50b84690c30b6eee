"""A lock on a directory for one process; the system releases it if the process dies."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from ..errors import OutputError
from .atomic import cannot_write

try:
    import fcntl
except ImportError:  # Windows: there, another process cannot replace an open file anyway
    fcntl = None  # type: ignore[assignment]

LOCK_NAME = ".lock"
"""File that is locked. It is removed at the end; a file left by a killed process is not locked."""


class Locked(Exception):
    """Another process, or another run of this one, holds the lock."""


@contextmanager
def locked(directory: Path) -> Iterator[None]:
    """Hold the lock of a directory inside the block.

    Raises:
        Locked: it is already held; raised without waiting.
        OSError: the file cannot be made.
    """
    path = Path(directory) / LOCK_NAME
    file = _hold(path)
    try:
        yield
    finally:
        with suppress(OSError):
            if os.fstat(file).st_size == 0:  # the lock file is empty; other files belong to the user
                path.unlink()  # before the lock is released, so that no other lock file is removed
        os.close(file)


@contextmanager
def alone_in(directory: Path, what: str) -> Iterator[None]:
    """As ``locked``, with an error message if it is held; ``what`` is a run or a study.

    Raises:
        OutputError: another one is running there, or the directory cannot be written.
    """
    with ExitStack() as held:
        try:
            held.enter_context(locked(directory))
        except Locked:
            raise OutputError(
                f"cannot write '{directory}': another {what} is writing there; "
                "wait for its end, or write elsewhere with --out DIR"
            ) from None
        except OSError as error:
            raise cannot_write(directory, error) from error
        yield


def _hold(path: Path) -> int:
    while True:
        file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            _lock(file)
            # Between opening and locking, the previous holder may have removed the file.
            if path.exists() and os.path.samestat(os.fstat(file), path.stat()):
                return file
        except BaseException:
            os.close(file)
            raise
        os.close(file)


def _lock(file: int) -> None:
    if fcntl is None:
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError) as error:
        raise Locked from error
    except OSError:
        pass  # a file system without locks: run without a lock
