"""Processes of this machine to run members in."""

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

    Whatever ends the block, no process goes on after it, and none leaves a file behind: not even one that
    was killed.

    Args:
        workers: processes at a time.
        each_alone: whether each member gets a process of its own, so that one that dies takes no other along.
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
    """Processes that leave Ctrl-C to their parent."""

    def __init__(self, workers: int, place: str) -> None:
        # Spawned, not forked: numba's threads do not survive a fork.
        context = multiprocessing.get_context("spawn")
        super().__init__(workers, mp_context=context, initializer=_begin, initargs=(place,))

    def submit(self, work: Callable, /, *arguments: Any, **options: Any) -> Future:
        with _interrupts_held_back():  # here processes start, and inherit it
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
    """Ctrl-C goes to every process of a terminal: one that is just starting would answer with a traceback."""
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
