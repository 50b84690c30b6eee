"""Display of a run: a progress bar on a terminal, otherwise a line at intervals; at the end a summary."""

from __future__ import annotations

import json
import logging
import time as clock
from collections.abc import Callable, Iterable
from contextlib import nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numba.core import event
from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, ProgressColumn, TaskProgressColumn, TextColumn
from rich.table import Column
from rich.text import Text

from ..output.log import RECORD
from ..output.summary import UNITS, lifted_later, state_at_end
from .duration import duration
from .printing import echo

if TYPE_CHECKING:
    from ..running import runner
    from .terminal_plot import HistoryPlot

LOGGER = logging.getLogger("mpmkit")
LINE_INTERVAL = 30.0
"""Seconds between two lines if the output is not a terminal."""
LONGEST_NAME = 24
"""Largest number of letters of a case's name beside the bar."""
NARROWEST_BAR, WIDEST_BAR = 10, 40
PERCENTAGE = len("100% ")
FIGURES = (
    ("t500", "T500", 1, " s", 3),
    ("t500_from_lift", "T500 from the lift", 1, " s", 3),
    ("final_spread", "final spread", 1e3, " mm", 1),
    ("final_slump", "final slump", 1e3, " mm", 1),
    ("final_height", "final height", 1e3, " mm", 1),
    ("particles", "particles", 1, "", 0),
    ("steps", "steps", 1, "", 0),
    ("wall_time", "wall time", 1, " s", 1),
)
"""Entries of the summary: key, label, scale, unit and digits."""
PARTICLE_STEPS = "particle-steps per second"
MILLION = 1e6


class _Screen(Console):
    """Stops printing if its reader is gone; rich itself would end the process, and the run with it."""

    def on_broken_pipe(self) -> None:
        self.quiet = True


console = _Screen(stderr=True)


def say(line: str, style: str | None = None) -> None:
    """Print a line beside the progress bar; it is not wrapped, and its content sets no colours.

    An error of the output, such as a full disk or a closed pipe, must not stop the run. It is ignored.
    """
    with suppress(OSError):
        console.print(line, style=style, soft_wrap=True, highlight=False, markup=False)


class Display(logging.Handler):
    """Shows the log and the progress of a run; a context manager, called with every ``runner.Progress``.

    Errors of the log are not shown here, because ``main`` prints them at the end. Nothing is shown before the
    first message of the run, so that a case that is refused is reported in one sentence only.

    Args:
        name: of the run.
        plotted: directory of the run, whose history is plotted below the bar; None for no plot.
    """

    def __init__(self, name: str, plotted: Path | None = None) -> None:
        super().__init__()
        self._plot = None if plotted is None else _plot_of(plotted)
        self._until = 1.0  # s
        self._room = console.width - min(len(name), LONGEST_NAME) - PERCENTAGE - 3  # for the bar and its line
        width = min(max(self._room - len(_lines(0.1234, 100.0, 1e7, 35999)[0]), NARROWEST_BAR), WIDEST_BAR)
        self._room -= width
        self._bar = _BarAndPlot(
            self._plot,
            TextColumn(
                "[bold]{task.description}",
                table_column=Column(no_wrap=True, overflow="ellipsis", max_width=LONGEST_NAME),
            ),
            BarColumn(width),
            TaskProgressColumn(),
            TextColumn("{task.fields[line]}", table_column=Column(no_wrap=True)),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(name, total=1.0, line="")
        self._started = False
        self._waiting: list[Callable[[], None]] = []
        """functions to call after the first message of the run"""
        self._compiling = _Compiling(self._say_compiling)
        self._said = clock.monotonic()
        self._level_before = LOGGER.level

    def __enter__(self) -> Display:
        LOGGER.addHandler(self)
        LOGGER.setLevel(logging.INFO)
        event.register("numba:compile", self._compiling)
        return self

    def __exit__(self, *error: object) -> None:
        event.unregister("numba:compile", self._compiling)
        if self._plot is not None:
            self._plot.look(self._until)
        self._bar.stop()
        if self._plot is not None and not console.is_terminal:
            for line in self._plot.lines:
                say(line)
        LOGGER.removeHandler(self)
        LOGGER.setLevel(self._level_before)

    def once_started(self, call: Callable[[], None]) -> None:
        """Call a function after the first message of the run; can be called from any thread."""
        with self.lock or nullcontext():  # in which ``emit`` is called as well
            if not self._started:
                self._waiting.append(call)
                return
        call()

    def emit(self, record: logging.LogRecord) -> None:
        if record.name == RECORD.name:
            return
        if record.levelno < logging.WARNING:
            say(record.getMessage())
        elif record.levelno < logging.ERROR:
            say(f"warning: {record.getMessage()}", style="yellow")
        if not self._started:
            self._started = True
            for call in self._waiting:
                call()
            self._bar.start()

    def _say_compiling(self) -> bool:
        """Say that kernels are compiled, after the first message of the run; return whether it was said."""
        if self._started:
            say("compiling kernels for the first run of this kind, which takes about 20 seconds")
        return self._started

    def __call__(self, progress: runner.Progress) -> None:
        lines = _lines(
            progress.time,
            progress.until,
            progress.particle_steps_per_second,
            progress.seconds_left,
            progress.ends_earlier,
        )
        self._until = progress.until
        if self._plot is not None:
            self._plot.look(self._until)
        fitting = next((line for line in lines if len(line) <= self._room), "")
        self._bar.update(self._task, completed=progress.time / progress.until, line=fitting)
        if not console.is_terminal and clock.monotonic() - self._said > LINE_INTERVAL:
            self._said = clock.monotonic()
            say(lines[0])


def _plot_of(directory: Path) -> HistoryPlot:
    from .terminal_plot import HistoryPlot

    return HistoryPlot(directory)


class _BarAndPlot(Progress):
    """The bar, and the plot of the history below it."""

    def __init__(self, plot: HistoryPlot | None, *columns: ProgressColumn, **settings: Any) -> None:
        self._plot = plot
        super().__init__(*columns, **settings)

    def get_renderables(self) -> Iterable[RenderableType]:
        yield from super().get_renderables()
        if self._plot is not None and self._plot.lines:
            yield Text("\n".join(self._plot.lines), no_wrap=True, overflow="crop")


class _Compiling(event.Listener):
    """Calls ``say`` at each kernel that is compiled instead of loaded, until ``say`` returns True."""

    def __init__(self, say: Callable[[], bool]) -> None:
        self._say = say
        self._said = False

    def on_start(self, _: event.Event) -> None:
        self._said = self._said or self._say()

    def on_end(self, _: event.Event) -> None:
        pass


def _lines(
    time: float, until: float, speed: float, seconds_left: float, ends_earlier: bool = False
) -> tuple[str, ...]:
    """Texts beside the bar, from the longest to the shortest: a narrow terminal shows only the last."""
    at_most = "at most " if ends_earlier else ""
    left = f"{at_most}{duration(seconds_left)} left"
    now = f"t = {time:.4g} of {at_most}{until:g} s"
    return f"{now} · {_speed(speed, 'M')} particle-steps/s · {left}", f"{now} · {left}", left


def _speed(speed: float, million: str) -> str:
    """A number of particle-steps per second, in millions if it is not small."""
    return f"{speed / MILLION:.2f} {million}" if speed >= MILLION / 10 else f"{speed:,.0f}"


def show_summary(directory: Path) -> None:
    """Print the numbers of ``summary.json`` and the run directory on standard output."""
    summary = json.loads((directory / "summary.json").read_text(encoding="utf-8"))
    width = max(len(PARTICLE_STEPS), *(len(label) for _, label, *_ in FIGURES))
    shown = [figure for figure in FIGURES if figure[0] != "t500_from_lift" or lifted_later(summary)]
    for key, label, scale, unit, digits in shown:
        value = summary[key]
        figure = "–" if value is None else f"{value * scale:,.{digits}f}{unit}"
        if key == "final_spread" and (state := state_at_end(summary)) is not None:
            figure += f", {state}"
        echo(f"{label:<{width}}  {figure}")
    speed = summary["particle_steps_per_second"]
    rate = "–" if speed is None else _speed(speed, "million")
    echo(f"{PARTICLE_STEPS:<{width}}  {rate}")
    for name in [name for name in summary["units"] if name not in UNITS]:
        unit = summary["units"][name].removeprefix("1")
        value = summary[name]
        echo(f"{name:<{width}}  {'–' if value is None else f'{value:.4g} {unit}'.rstrip()}")
    echo(f"results in {directory}")
