"""What a person sees of a run: a progress bar on a terminal, a line now and then elsewhere, and a summary."""

from __future__ import annotations

import json
import logging
import time as clock
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn
from rich.table import Table

if TYPE_CHECKING:
    from .. import runner

LINE_INTERVAL = 30.0
"""Seconds between lines where the output is not a terminal."""

console = Console(stderr=True)


class Display:
    """Shows the progress of a run; a context manager that is called with every ``runner.Progress``."""

    def __init__(self, name: str) -> None:
        self._bar = Progress(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[line]}"),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(name, total=1.0, line="compiling kernels on the first run")
        self._said = clock.monotonic()

    def __enter__(self) -> Display:
        self._bar.__enter__()
        if not console.is_terminal:
            console.print("loading kernels (compiled on the first run, about half a minute)", highlight=False)
        return self

    def __exit__(self, *error: object) -> None:
        self._bar.__exit__(*error)  # type: ignore[arg-type]

    def __call__(self, progress: runner.Progress) -> None:
        line = (
            f"t = {progress.time:.4g} of {progress.until:g} s · "
            f"{progress.particle_steps_per_second / 1e6:.2f} M particle-steps/s · {_duration(progress.seconds_left)} left"
        )
        self._bar.update(self._task, completed=progress.time / progress.until, line=line)
        if not console.is_terminal and clock.monotonic() - self._said > LINE_INTERVAL:
            self._said = clock.monotonic()
            console.print(line, highlight=False)


def _duration(seconds: float) -> str:
    if seconds != seconds:
        return "?"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


class TerminalHandler(logging.Handler):
    """Prints what the package logs beside the progress bar. Errors are left to the last sentence of ``main``."""

    def emit(self, record: logging.LogRecord) -> None:
        if record.levelno < logging.ERROR:
            style = "yellow" if record.levelno >= logging.WARNING else None
            prefix = "warning: " if record.levelno >= logging.WARNING else ""
            console.print(
                prefix + record.getMessage(), style=style, soft_wrap=True, highlight=False, markup=False
            )


def show_log(level: int) -> None:
    """Show what the package logs from ``level`` on."""
    logger = logging.getLogger("mpmkit")
    logger.handlers = [TerminalHandler(level)]
    logger.setLevel(logging.INFO)


def show_summary(directory: Path) -> None:
    """The figures of ``summary.json``, and where everything lies."""
    summary = json.loads((directory / "summary.json").read_text(encoding="utf-8"))
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="bold")
    table.add_column(justify="right")
    table.add_column()
    for key, label, scale, unit, digits in (
        ("t500", "T500", 1, "s", 3),
        ("final_spread", "final spread", 1e3, "mm", 1),
        ("final_slump", "final slump", 1e3, "mm", 1),
        ("final_height", "final height", 1e3, "mm", 1),
        ("particles", "particles", 1, "", 0),
        ("steps", "steps", 1, "", 0),
        ("wall_time", "wall time", 1, "s", 1),
        ("particle_steps_per_second", "particle-steps a second", 1e-6, "million", 2),
    ):
        value = summary[key]
        table.add_row(
            label, "never" if value is None else f"{value * scale:,.{digits}f}", "" if value is None else unit
        )
    console.print(table)
    console.print(f"results in {directory}", highlight=False)
