"""Running the members of a study on any executor of ``concurrent.futures``."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor, as_completed

from ..errors import reason
from .members import Member
from .store import Store
from .work import Outcome, run_member

LOST = 3
"""Times that workers may die around a member before it is given up."""

Listener = Callable[[Member, Outcome], None]


def execute(
    members: list[Member],
    store: Store,
    threads: int = 1,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    listen: Listener | None = None,
) -> None:
    """Run all members that have not finished yet; one that fails does not stop the others.

    Args:
        members: of the study.
        store: keeps what each gave, as soon as it is there.
        threads: of each member.
        executor: runs them; processes of this machine unless given.
        workers: how many at once on this machine; as many as its cores hold of ``threads`` unless told.
        listen: told of each member that has come to its end.

    Raises:
        KeyboardInterrupt: what has finished is kept.
        OutputError: the store cannot be written.
    """
    left = [member for member in members if store.outcome(member) is None]
    workers = workers or max(1, (os.cpu_count() or 1) // threads)
    lost = dict.fromkeys(range(len(left)), 0)

    def done(number: int, outcome: Outcome) -> None:
        store.keep(left[number], outcome)
        del lost[number]
        if listen is not None:
            listen(left[number], outcome)

    while lost:
        # Whose fault it was when a pool broke nobody says: the second time each member gets its own.
        alone = any(lost.values())
        for batch in [[number] for number in lost] if alone else [list(lost)]:
            pool = executor or _processes(1 if alone else workers)
            broken = _run(pool, {number: left[number] for number in batch}, threads, done, executor is None)
            for number in broken:
                lost[number] += 1
                if lost[number] >= LOST:
                    done(number, Outcome("failed", "the process that ran it died", {}, {}, b""))


def _run(
    pool: Executor, members: dict[int, Member], threads: int, done: Callable[[int, Outcome], None], own: bool
) -> list[int]:
    """Run members in a pool; returns those that were lost with it."""
    futures = {pool.submit(run_member, member.data, threads): number for number, member in members.items()}
    broken = []
    try:
        for future in as_completed(futures):
            number = futures[future]
            try:
                outcome = future.result()
            except BrokenExecutor:
                broken.append(number)
                continue
            except Exception as error:  # of the way there or back
                outcome = Outcome("failed", reason(error), {}, {}, b"")
            done(number, outcome)
    except BaseException:
        for future in futures:
            future.cancel()
        if own:
            for process in multiprocessing.active_children():
                process.terminate()
        raise
    finally:
        if own:
            pool.shutdown(wait=False, cancel_futures=True)
    return broken


def _processes(workers: int) -> Executor:
    # Spawned, not forked: numba's threads do not survive a fork.
    return ProcessPoolExecutor(
        workers, mp_context=multiprocessing.get_context("spawn"), initializer=_leave_interrupts_to_the_parent
    )


def _leave_interrupts_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
