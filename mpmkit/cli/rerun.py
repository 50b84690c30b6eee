"""``mpmkit rerun``."""

from __future__ import annotations

from pathlib import Path

import click

from . import options
from .command import with_examples
from .paths import PATH
from .printing import echo


@with_examples(
    "rerun", "mpmkit run cases/slump_fast.json --until 0.2 --out runs/short", "mpmkit rerun runs/short"
)
@click.argument("directory", type=PATH)
@click.option("--out", type=PATH, metavar="DIR", help="Directory of the new run; default: DIRECTORY-rerun.")
@options.threads
@options.overwrite
@options.quiet
def command(directory: str, out: str | None, threads: int | None, overwrite: bool, quiet: bool) -> None:
    """Repeat the run in DIRECTORY, and compare the results bit by bit.

    The exit status is 1 if they differ.
    """
    from ..running.interrupts import take_signals_as_interrupts
    from ..running.rerun import first_difference, history_of, made_differently
    from ..running.resume import case_of
    from .run import perform

    path = Path(directory)
    case, before = case_of(path), history_of(path)
    target = Path(out) if out is not None else path.with_name(f"{path.resolve().name}-rerun")
    for sentence in made_differently(before, case, threads or 1):
        echo(f"changed since the run: {sentence}")
    take_signals_as_interrupts()
    perform(target, quiet, resumed=False, case=case, overwrite=overwrite, threads=threads,
            checkpoint_every=None)  # fmt: skip
    apart = first_difference(before, history_of(target))
    if apart is not None:
        echo(f"not the same: {apart}")
        raise click.exceptions.Exit(1)
    echo(f"the same bits, in {before.sizes['time']} rows of the history")
