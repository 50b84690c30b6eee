"""``mpmkit run``."""

from __future__ import annotations

import signal
from pathlib import Path

import click

from . import options


@click.command("run")
@options.case_file
@options.out
@options.set_values
@options.until
@options.threads
@options.overwrite
@options.quiet
def command(
    case: str,
    out: str | None,
    overrides: tuple[str, ...],
    until: float | None,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
) -> None:
    """Run CASE and write its history, frames, summary and report into a run directory."""
    from ..case import load_case

    loaded = load_case(case, options.with_until(overrides, until))
    directory = Path(out) if out is not None else Path("runs") / loaded.name

    import numpy as np  # from here on, after the case is read: a bad case is refused without loading all this

    from ..runner import run

    signal.signal(signal.SIGTERM, signal.default_int_handler)  # a cluster ends runs so
    with np.errstate(all="ignore"):  # a run that diverges is told of by its guard, not by every array
        if quiet:
            run(loaded, directory, overwrite=overwrite, threads=threads)
            return

        from .display import Display, show_summary

        with Display(loaded.name) as display:
            run(loaded, directory, overwrite=overwrite, threads=threads, listen=display)
    show_summary(directory)
