"""``mpmkit run``."""

from __future__ import annotations

import json
import logging
from pathlib import Path

import click

from . import options


@click.command("run")
@options.case_file
@options.out
@options.set_values
@click.option("--until", type=float, metavar="T", help="Simulated time, s, instead of the case's.")
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

    if until is not None:
        overrides = (*overrides, f"until={json.dumps(until)}")
    loaded = load_case(case, overrides)
    directory = Path(out) if out is not None else Path("runs") / loaded.name

    from ..runner import run  # after the case is read: what it costs to load is not spent on a bad case
    from .display import Display, show_log, show_summary

    show_log(logging.ERROR if quiet else logging.INFO)
    if quiet:
        run(loaded, directory, overwrite=overwrite, threads=threads)
        return
    with Display(loaded.name) as display:
        run(loaded, directory, overwrite=overwrite, threads=threads, listen=display)
    show_summary(directory)
