"""Running the members of a study on any executor of ``concurrent.futures``."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, as_completed
from contextlib import AbstractContextManager, nullcontext

from ..errors import MpmkitError, reason
from .members import Member
from .processes import cores, processes
from .store import Store
from .work import FAILED, Outcome, PageOf, run_member

MOST_NAMED = 5
"""Most members that a sentence names."""
LOST = 3
"""How often the worker of a member may die before the member counts as failed."""


class Unfinished(MpmkitError):
    """Some members have no result: the exit status is 1, and the study can be continued."""


Listener = Callable[[Member, Outcome], None]


def execute(
    members: list[Member],
    store: Store,
    threads: int = 1,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    listen: Listener | None = None,
    page: str | None = None,
) -> None:
    """Run all members without a result; a member that fails does not stop the others.

    Args:
        members: of the study.
        store: saves the result of each member as soon as it is available.
        threads: of each member.
        executor: runs them; default: processes of this machine.
        workers: how many at once on this machine; default: as many as its cores hold of ``threads``.
        listen: called for each member that has ended.
        page: file name of the page of the study, to which the page of each member links; None if the members
            shall have no pages.

    Raises:
        KeyboardInterrupt: results of finished members are kept.
        Unfinished: the executor gave up members, for example because its scheduler has died; finished
        members are kept.
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
        # A broken pool does not say which member broke it: the second time, each member gets its own process.
        pool: AbstractContextManager[Executor] = (
            processes(min(workers or max(1, cores() // threads), len(lost)), any(lost.values()))
            if executor is None
            else nullcontext(executor)
        )
        with pool as at_work:
            broken, given_up = _run(at_work, {number: left[number] for number in lost}, threads, page, done)
        if given_up:
            titles = [left[number].title for number in sorted(given_up)]
            raise Unfinished(
                f"the executor gave up {named(titles, len(members))}; run the same study again to continue"
            )
        for number in broken:
            lost[number] += 1
            if lost[number] >= LOST:
                done(number, Outcome(FAILED, "the process that ran it died", {}, {}, b""))


def named(titles: list[str], total: int) -> str:
    """How many of all members, with the names of the first few."""
    few = ", ".join(titles[:MOST_NAMED]) + (", …" if len(titles) > MOST_NAMED else "")
    return f"{len(titles)} of {total} members ({few})"


def _run(
    pool: Executor,
    members: dict[int, Member],
    threads: int,
    page: str | None,
    done: Callable[[int, Outcome], None],
) -> tuple[list[int], list[int]]:
    """Run members in a pool; return members whose workers died, and members that the pool gave up."""
    futures: dict[Future, int] = {}
    broken, given_up = [], []
    try:
        for number, member in members.items():
            try:
                wanted = None if page is None else PageOf(member.heading, f"../../{page}")
                futures[pool.submit(run_member, member.data, threads, wanted)] = number
            except BrokenExecutor:  # while members were still being submitted
                broken.append(number)
        for future in as_completed(futures):
            number = futures[future]
            try:
                outcome = future.result()
            except BrokenExecutor:
                broken.append(number)
                continue
            except CancelledError:  # a scheduler that has died cancels its futures
                given_up.append(number)
                continue
            except Exception as error:  # of the transfer to or from the worker
                outcome = Outcome(FAILED, reason(error), {}, {}, b"")
            done(number, outcome)
    except BaseException:
        for future in futures:
            future.cancel()
        raise
    return broken, given_up
