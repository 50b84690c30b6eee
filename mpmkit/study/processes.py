"""Processes of this machine that run members."""

from __future__ import annotations

import multiprocessing
import os
import signal
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any


@contextmanager
def processes(workers: int, each_alone: bool) -> Iterator[Executor]:
    """An executor that runs ``workers`` members at once.

    After the block no process is left, however the block ends. No process leaves temporary files, not even
    one that was killed.

    Args:
        workers: processes at a time.
        each_alone: whether each member gets its own process, so that a crash affects no other member.
    """
    others = set(multiprocessing.active_children())
    with tempfile.TemporaryDirectory(prefix="mpmkit-study-", ignore_cleanup_errors=True) as place:
        pool = _Alone(workers, place) if each_alone else _Pool(workers, place)
        try:
            yield pool
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            _end(set(multiprocessing.active_children()) - others)
            raise
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def cores() -> int:
    """Cores that this process may use, which on a cluster are fewer than the machine has."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _Pool(ProcessPoolExecutor):
    """Processes that ignore Ctrl-C; their parent handles it."""

    def __init__(self, workers: int, place: str) -> None:
        # Spawned, not forked: numba's threads do not survive a fork.
        context = multiprocessing.get_context("spawn")
        super().__init__(workers, mp_context=context, initializer=_begin, initargs=(place,))

    def submit(self, work: Callable, /, *arguments: Any, **options: Any) -> Future:
        with _interrupts_held_back():  # processes start here and inherit the setting
            return super().submit(work, *arguments, **options)


class _Alone(ThreadPoolExecutor):
    """A process for each piece of work, and a thread that waits for it."""

    def __init__(self, workers: int, place: str) -> None:
        super().__init__(workers)
        self._place = place

    def submit(self, work: Callable, /, *arguments: Any, **options: Any) -> Future:
        return super().submit(self._in_its_own, work, arguments, options)

    def _in_its_own(self, work: Callable, arguments: tuple, options: dict) -> Any:
        with _Pool(1, self._place) as pool:
            return pool.submit(work, *arguments, **options).result()


@contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """A terminal sends Ctrl-C to all its processes: one that is just starting would print a traceback."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(place: str) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    tempfile.tempdir = place


def _end(children: set) -> None:
    for process in children:
        process.terminate()
    for process in children:
        process.join()
