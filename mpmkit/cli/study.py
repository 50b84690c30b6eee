"""``mpmkit study``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from . import options

if TYPE_CHECKING:
    from ..study import Study


@click.command("study")
@click.argument("study", type=click.Path())
@options.out
@options.workers
@options.threads
@options.scheduler
@options.quiet
def command(
    study: str, out: str | None, workers: int | None, threads: int | None, scheduler: str | None, quiet: bool
) -> None:
    """Run the variations that STUDY describes, and gather them in one dataset, figures and a table.

    Members that have run already, of the same case and with the same versions, are not run again.
    """
    from ..study import load_study

    run_study(load_study(study), out, workers, threads, scheduler, quiet)


def run_study(
    study: Study,
    out: str | None,
    workers: int | None,
    threads: int | None,
    scheduler: str | None,
    quiet: bool,
) -> None:
    """Run a study into its directory and say what came of it."""
    from contextlib import nullcontext

    from ..study import collect, execute, members_of
    from ..study.store import Store

    members = members_of(study)
    store = Store(Path(out) if out is not None else Path("runs") / study.name)
    store.open(study)
    from .progress import StudyProgress

    if not quiet:
        from .display import say

        for sentence in dict.fromkeys(remark for member in members for remark in member.remarks):
            say(sentence)
    already = sum(store.outcome(member) is not None for member in members)
    progress = None if quiet else StudyProgress(study.name, len(members), already)
    with _cluster(scheduler) as executor, progress or nullcontext():
        try:
            execute(
                members,
                store,
                threads or study.threads,
                executor=executor,
                workers=workers,
                listen=progress,
            )
        finally:
            store.write(collect(study, members, store))
    if not quiet:
        click.echo((store.path / "table.md").read_text(encoding="utf-8"), nl=False)
        click.echo(f"results in {store.path}")


def _cluster(scheduler: str | None):
    from contextlib import nullcontext

    if scheduler is None:
        return nullcontext()
    from ..study.cluster import cluster

    return cluster(scheduler)
