"""Running the members of a study on any executor of ``concurrent.futures``."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, as_completed
from contextlib import AbstractContextManager, nullcontext

from ..errors import reason
from .members import Member
from .processes import cores, processes
from .store import Store
from .work import FAILED, Outcome, run_member

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
    """Run all members that have not come to an end yet; one that fails does not stop the others.

    Args:
        members: of the study.
        store: keeps what each gave, as soon as it is there.
        threads: of each member.
        executor: runs them; default: processes of this machine.
        workers: how many at once on this machine; default: as many as its cores hold of ``threads``.
        listen: called for each member that has ended.

    Raises:
        KeyboardInterrupt: what has finished is kept.
        OutputError: the store cannot be written.
    """
    left = {number: member for number, member in enumerate(members) if not store.settled(member)}
    lost = dict.fromkeys(left, 0)

    def done(number: int, outcome: Outcome) -> None:
        store.keep(left[number], outcome)
        del lost[number]
        if listen is not None:
            listen(left[number], outcome)

    while lost:
        # Whose fault it was when a pool broke nobody says: the second time each member gets its own.
        pool: AbstractContextManager[Executor] = (
            processes(min(workers or max(1, cores() // threads), len(lost)), any(lost.values()))
            if executor is None
            else nullcontext(executor)
        )
        with pool as at_work:
            broken = _run(at_work, {number: left[number] for number in lost}, threads, done)
        for number in broken:
            lost[number] += 1
            if lost[number] >= LOST:
                done(number, Outcome(FAILED, "the process that ran it died", {}, {}, b""))


def _run(
    pool: Executor, members: dict[int, Member], threads: int, done: Callable[[int, Outcome], None]
) -> list[int]:
    """Run members in a pool; returns those that were lost with it."""
    futures: dict[Future, int] = {}
    broken = []
    try:
        for number, member in members.items():
            try:
                futures[pool.submit(run_member, member.data, threads)] = number
            except BrokenExecutor:  # while the last of them were still being handed over
                broken.append(number)
        for future in as_completed(futures):
            number = futures[future]
            try:
                outcome = future.result()
            except BrokenExecutor:
                broken.append(number)
                continue
            except Exception as error:  # of the way there or back
                outcome = Outcome(FAILED, reason(error), {}, {}, b"")
            done(number, outcome)
    except BaseException:
        for future in futures:
            future.cancel()
        raise
    return broken
