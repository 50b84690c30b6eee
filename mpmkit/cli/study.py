"""``mpmkit study``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from .command import with_examples
from .many_runs import ManyRuns, study_runs
from .paths import PATH
from .printing import echo

if TYPE_CHECKING:
    from ..study import Member, Study
    from ..study.store import Store
    from .progress import StudyProgress


@with_examples("study", "mpmkit study cases/studies/yield_stress_fast.json")
@click.argument("study", type=PATH)
@study_runs("runs/<study name>")
def command(study: str, how: ManyRuns) -> None:
    """Run the variations that STUDY describes, and write one dataset, figures, a table and a page.

    Members that have run already, of the same case and with the same versions, are not run again.
    The exit status is 1 if members failed or were not run.
    """
    from ..study import load_study

    run_study(load_study(study), how)


def run_study(study: Study, how: ManyRuns) -> None:
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
    store = Store(how.directory(study.name), how.overwrite)
    threads = how.threads or study.threads
    take_signals_as_interrupts()
    # The cluster first: if there is none, nothing is written.
    with how.cluster() as executor, store.claimed(study, members):
        at_once = how.workers or max(1, cores() // threads)
        progress = None if how.quiet else _progress(study, members, store, at_once, threads)
        with progress or nullcontext():
            try:
                execute(
                    members,
                    store,
                    threads,
                    executor=executor,
                    workers=how.workers,
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
    if not how.quiet:
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
