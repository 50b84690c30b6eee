"""``mpmkit run``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from . import options
from .command import with_examples
from .duration import SECONDS
from .paths import PATH

if TYPE_CHECKING:
    from ..watch import Watch
    from .display import Display


@with_examples(
    "run",
    "mpmkit run cases/slump_fast.json",
    "mpmkit run cases/slump_fast.json --until 0.5 --set bodies.0.material.yield_stress=400 --out runs/stiff",
    "mpmkit run --resume runs/stiff --until 0.6",
    "mpmkit run cases/slump_fast.json --until 0.5 --watch --plot --out runs/watched",
)
@click.argument("case", type=PATH, required=False)
@options.out
@options.set_values
@options.until
@options.threads
@options.overwrite
@options.quiet
@click.option(
    "--watch",
    is_flag=True,
    help="Serve the page of the run while it runs, only on this machine, and print the address.",
)
@click.option("--open", "opened", is_flag=True, help="Open that page in a browser; includes --watch.")
@click.option("--plot", is_flag=True, help="Plot the spread, or what changes, in the terminal meanwhile.")
@click.option(
    "--checkpoint-every",
    type=SECONDS,
    metavar="TIME",
    help="Wall time between two checkpoints, such as 60s, 10min or 1h. One is always written on Ctrl-C and "
    "before the last step.",
)
@click.option(
    "--resume",
    "stopped",
    type=PATH,
    metavar="DIR",
    help="Continue the run in this directory from its last checkpoint; CASE may be left out. With --until, "
    "a finished run is continued to a later time.",
)
def command(
    case: str | None,
    out: str | None,
    overrides: tuple[str, ...],
    until: float | None,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
    watch: bool,
    opened: bool,
    plot: bool,
    checkpoint_every: float | None,
    stopped: str | None,
) -> None:
    """Run CASE and write its history, frames, summary and report into a run directory."""
    if stopped is not None and (out is not None or overwrite):
        raise click.UsageError("--resume continues in its own directory: leave out --out and --overwrite")
    if stopped is None and case is None:
        raise click.UsageError("Missing argument 'CASE'")
    if stopped is not None and case is None and overrides:
        raise click.UsageError("--resume continues with the case as it was: leave out --set")

    if quiet and (watch or opened or plot):
        raise click.UsageError("--watch, --open and --plot show something: leave out --quiet")

    from ..case import load_case
    from ..running.interrupts import take_signals_as_interrupts

    take_signals_as_interrupts()
    settings: dict[str, Any] = {"threads": threads, "checkpoint_every": checkpoint_every}
    settings |= {"watch": watch or opened, "opened": opened, "plot": plot}
    if stopped is not None:
        loaded = None if case is None else load_case(case, overrides)
        perform(Path(stopped), quiet, resumed=True, case=loaded, until=until, **settings)
    else:
        assert case is not None
        loaded = load_case(case, options.with_until(overrides, until))
        directory = Path(out) if out is not None else Path("runs") / loaded.name
        perform(directory, quiet, resumed=False, case=loaded, overwrite=overwrite, **settings)


def perform(
    directory: Path,
    quiet: bool,
    *,
    resumed: bool,
    case: Any,
    watch: bool = False,
    opened: bool = False,
    plot: bool = False,
    **settings: Any,
) -> None:
    """Run a case in a directory, or continue its run, with the display that the options ask for.

    Args:
        directory: of the run.
        quiet: whether to show only errors.
        resumed: whether a run is continued.
        case: the case; None for that of the directory.
        watch: whether to serve its page during the run.
        opened: whether to open that page in a browser.
        plot: whether to plot its history in the terminal.
        settings: for ``run``, or for ``resume``.
    """
    from contextlib import nullcontext, suppress

    import numpy as np  # imported after the case is read: a bad case is refused faster

    from ..errors import Undrawn
    from ..output.netcdf import leave_dask_out
    from ..running.ahead import compile_ahead
    from ..running.runner import resume, run

    if case is not None:
        compile_ahead(case, settings.get("threads"))
    leave_dask_out()

    def go(listen: Any) -> None:
        if resumed:
            resume(directory, case=case, listen=listen, **settings)
        else:
            run(case, directory, listen=listen, **settings)

    with np.errstate(all="ignore"):  # a guard reports a run that diverges; warnings of NumPy are not needed
        if quiet:
            with suppress(Undrawn):
                go(None)
            return

        from .display import Display, say, show_summary

        name = directory.name if case is None else case.name
        plotted = directory if plot else None
        with (
            Display(name, plotted) as display,
            _served(directory, resumed, opened, display) if watch else nullcontext(),
        ):
            try:
                go(display)
            except Undrawn as undrawn:  # the run itself has finished
                say(f"warning: {undrawn}", style="yellow")
    show_summary(directory)


def _served(directory: Path, resumed: bool, opened: bool, display: Display) -> Watch:
    """Serve the page of a run; the address is printed when it is known and the run has started."""
    from ..watch import Watch
    from .display import say

    def tell(address: str) -> None:
        say(f"watch this run at {address}")
        if opened:
            click.launch(address)

    return Watch(directory, resumed, lambda address: display.once_started(lambda: tell(address)))
