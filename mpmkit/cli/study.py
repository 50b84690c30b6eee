"""``mpmkit study``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from . import options
from .command import with_examples
from .paths import PATH
from .printing import echo

if TYPE_CHECKING:
    from ..study import Member, Study
    from ..study.store import Store
    from .progress import StudyProgress


@with_examples("study", "mpmkit study cases/studies/yield_stress_fast.json")
@click.argument("study", type=PATH)
@options.study_out
@options.study_overwrite
@options.workers
@options.member_threads
@options.scheduler
@options.quiet
def command(
    study: str,
    out: str | None,
    overwrite: bool,
    workers: int | None,
    threads: int | None,
    scheduler: str | None,
    quiet: bool,
) -> None:
    """Run the variations that STUDY describes, and write one dataset, figures, a table and a page.

    Members that have run already, of the same case and with the same versions, are not run again.
    The exit status is 1 if members failed or were not run.
    """
    from ..study import load_study

    run_study(load_study(study), out, overwrite, workers, threads, scheduler, quiet)


def run_study(
    study: Study,
    out: str | None,
    overwrite: bool,
    workers: int | None,
    threads: int | None,
    scheduler: str | None,
    quiet: bool,
) -> None:
    """Run a study in its directory and print its results.

    Raises:
        Unfinished: members failed, or were not run.
    """
    from contextlib import nullcontext

    from ..errors import Interrupted
    from ..running.interrupts import take_signals_as_interrupts
    from ..study import collect, execute, members_of
    from ..study.execute import Unfinished, named
    from ..study.page import NAME
    from ..study.processes import cores
    from ..study.store import Store

    members = members_of(study)
    store = Store(Path(out) if out is not None else Path("runs") / study.name, overwrite)
    take_signals_as_interrupts()
    # The cluster first: if there is none, nothing is written.
    with _cluster(scheduler) as executor, store.claimed(study, members):
        at_once = workers or max(1, cores() // (threads or study.threads))
        progress = None if quiet else _progress(study, members, store, at_once, threads or study.threads)
        with progress or nullcontext():
            try:
                execute(
                    members,
                    store,
                    threads or study.threads,
                    executor=executor,
                    workers=workers,
                    listen=progress,
                    page=NAME if study.pages else None,
                )
            except KeyboardInterrupt:
                raise Interrupted(
                    f"interrupted; the members that had finished are in '{store.path}', and the same command "
                    "continues from there"
                ) from None
            finally:
                store.write(collect(study, members, store))
    if not quiet:
        echo((store.path / "table.md").read_text(encoding="utf-8"), nl=False)
        echo(f"results in {store.path}; open {store.path / NAME} in a browser")
    failed = [member.title for member in members if not store.settled(member)]
    if failed:
        raise Unfinished(
            f"{named(failed, len(members))} failed; member.json of each in '{store.path / 'members'}' says "
            "why, and the same command runs them again"
        )


def _progress(study: Study, members: list[Member], store: Store, at_once: int, threads: int) -> StudyProgress:
    from .display import say
    from .progress import StudyProgress

    for sentence in dict.fromkeys(remark for member in members for remark in member.remarks):
        say(sentence)
    for member in members:
        damaged = store.damaged(member)
        if damaged is not None:
            say(f"{member.title}: '{damaged}' is damaged; the member is run again")
    waiting = [member for member in members if not store.settled(member)]
    return StudyProgress(study.name, waiting, len(members) - len(waiting), at_once, threads)


def _cluster(scheduler: str | None):
    from contextlib import nullcontext

    if scheduler is None:
        return nullcontext()
    from ..study.cluster import cluster

    return cluster(scheduler)
