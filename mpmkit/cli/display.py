"""What a person sees of a run: a progress bar on a terminal, a line now and then elsewhere, and a summary."""

from __future__ import annotations

import json
import logging
import time as clock
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

from .duration import duration

if TYPE_CHECKING:
    from ..running import runner

LOGGER = logging.getLogger("mpmkit")
LINE_INTERVAL = 30.0
"""Seconds between lines where the output is not a terminal."""
FIGURES = (
    ("t500", "T500", 1, " s", 3),
    ("final_spread", "final spread", 1e3, " mm", 1),
    ("final_slump", "final slump", 1e3, " mm", 1),
    ("final_height", "final height", 1e3, " mm", 1),
    ("particles", "particles", 1, "", 0),
    ("steps", "steps", 1, "", 0),
    ("wall_time", "wall time", 1, " s", 1),
    ("particle_steps_per_second", "particle-steps a second", 1e-6, " million", 2),
)
"""What the summary shows: key, label, scale, unit and digits."""

console = Console(stderr=True)


def say(line: str, style: str | None = None) -> None:
    """A line beside the progress bar, never wrapped or coloured by its content.

    What nobody can read any more, on a full disk or a closed pipe, is not worth a run.
    """
    with suppress(OSError):
        console.print(line, style=style, soft_wrap=True, highlight=False, markup=False)


class Display(logging.Handler):
    """Shows the log and the progress of a run; a context manager, called with every ``runner.Progress``.

    Errors of the log are left to the last sentence of ``main``, and nothing is shown before the run has
    something to say: a case that is refused is told of in one sentence and no more.
    """

    def __init__(self, name: str) -> None:
        super().__init__()
        self._bar = Progress(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[line]}"),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(name, total=1.0, line="")
        self._started = False
        self._said = clock.monotonic()
        self._level_before = LOGGER.level

    def __enter__(self) -> Display:
        LOGGER.addHandler(self)
        LOGGER.setLevel(logging.INFO)
        return self

    def __exit__(self, *error: object) -> None:
        self._bar.stop()
        LOGGER.removeHandler(self)
        LOGGER.setLevel(self._level_before)

    def emit(self, record: logging.LogRecord) -> None:
        if record.levelno < logging.WARNING:
            say(record.getMessage())
        elif record.levelno < logging.ERROR:
            say(f"warning: {record.getMessage()}", style="yellow")
        if not self._started:
            self._started = True
            say("loading kernels; those that are new are compiled first, which takes about half a minute")
            self._bar.start()

    def __call__(self, progress: runner.Progress) -> None:
        line = (
            f"t = {progress.time:.4g} of {progress.until:g} s · "
            f"{progress.particle_steps_per_second / 1e6:.2f} M particle-steps/s · "
            f"{duration(progress.seconds_left)} left"
        )
        self._bar.update(self._task, completed=progress.time / progress.until, line=line)
        if not console.is_terminal and clock.monotonic() - self._said > LINE_INTERVAL:
            self._said = clock.monotonic()
            say(line)


def show_summary(directory: Path) -> None:
    """The figures of ``summary.json``, and where everything lies, on standard output."""
    summary = json.loads((directory / "summary.json").read_text(encoding="utf-8"))
    width = max(len(label) for _, label, *_ in FIGURES)
    for key, label, scale, unit, digits in FIGURES:
        value = summary[key]
        figure = "–" if value is None else f"{value * scale:,.{digits}f}{unit}"
        click.echo(f"{label:<{width}}  {figure}")
    click.echo(f"results in {directory}")
