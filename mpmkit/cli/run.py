"""``mpmkit run``."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Any

import click

from . import options
from .duration import SECONDS


@click.command("run")
@click.argument("case", type=click.Path(), required=False)
@options.out
@options.set_values
@options.until
@options.threads
@options.overwrite
@options.quiet
@click.option(
    "--checkpoint-every",
    type=SECONDS,
    metavar="TIME",
    help="Wall time between two checkpoints, such as 60s, 10min or 1h; on Ctrl-C there is one in any case.",
)
@click.option(
    "--resume",
    "stopped",
    type=click.Path(),
    metavar="DIR",
    help="Go on with the run in this directory from its last checkpoint; CASE may be left out.",
)
def command(
    case: str | None,
    out: str | None,
    overrides: tuple[str, ...],
    until: float | None,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
    checkpoint_every: float | None,
    stopped: str | None,
) -> None:
    """Run CASE and write its history, frames, summary and report into a run directory."""
    if stopped is not None and (out is not None or overwrite):
        raise click.UsageError("--resume goes on in its own directory: leave out --out and --overwrite")
    if stopped is None and case is None:
        raise click.UsageError("Missing argument 'CASE'")
    if stopped is not None and case is None and (overrides or until is not None):
        raise click.UsageError("--resume goes on with the case as it was: leave out --set and --until")

    from ..case import load_case

    loaded = None if case is None else load_case(case, options.with_until(overrides, until))
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # a cluster ends runs so
    if stopped is not None:
        directory = Path(stopped)
    else:
        directory = Path(out) if out is not None else Path("runs") / loaded.name  # type: ignore[union-attr]
    perform(directory, quiet, resumed=stopped is not None, case=loaded, overwrite=overwrite,
            threads=threads, checkpoint_every=checkpoint_every)  # fmt: skip


def perform(
    directory: Path, quiet: bool, *, resumed: bool, case: Any, overwrite: bool, **settings: Any
) -> None:
    """Run or go on in a directory, and show what a person wants to see of it."""
    import numpy as np  # from here on, after the case is read: a bad case is refused without loading all this

    from ..running.runner import resume, run

    def go(listen: Any) -> None:
        if resumed:
            resume(directory, case=case, listen=listen, **settings)
        else:
            run(case, directory, overwrite=overwrite, listen=listen, **settings)

    with np.errstate(all="ignore"):  # a run that diverges is told of by its guard, not by every array
        if quiet:
            go(None)
            return

        from .display import Display, show_summary

        with Display(directory.name if case is None else case.name) as display:
            go(display)
    show_summary(directory)
