"""A whole run: advance a case to its end and keep what it did, in memory or in a run directory."""

from __future__ import annotations

import logging
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from .blame import blaming_plugins
from .case.model import Case
from .cautions import cautions
from .conclusion import conclude, salvage
from .errors import GuardStop, Interrupted, OutputError, reason
from .memory import require_memory
from .output import RunDirectory, open_log, write_json
from .provenance import attributes, resolved
from .recorder import Recorder
from .solver.simulation import Simulation
from .threads import use_threads

if TYPE_CHECKING:
    import xarray

LOGGER = logging.getLogger("mpmkit")
COMPRESSIBLE = 0.1
"""Mach number above which the density may change by more than half a percent as the material flows."""
TOLD_EVERY = 0.2
"""Seconds between two calls of a listener."""


@dataclass(frozen=True)
class Progress:
    """What a progress display is told, a few times a second."""

    time: float
    until: float
    steps: int
    particle_steps_per_second: float
    seconds_left: float


Listener = Callable[[Progress], None]


class Stopwatch:
    """Wall time of a run from its first step on, s: what it takes to load and compile is not the run's."""

    def __init__(self) -> None:
        self._begin: float | None = None

    def start(self) -> None:
        self._begin = clock.monotonic()

    @property
    def elapsed(self) -> float:
        return 0.0 if self._begin is None else clock.monotonic() - self._begin


def run(
    case: Case,
    out: str | Path | None = None,
    *,
    overwrite: bool = False,
    threads: int | None = None,
    listen: Listener | None = None,
) -> xarray.Dataset:
    """Run a case to its end.

    Args:
        case: a validated case.
        out: run directory to write; nothing is written without one.
        overwrite: whether an earlier run in ``out`` may be replaced.
        threads: threads to use; as many as pay off unless told.
        listen: told of the progress a few times a second.

    Returns:
        The history, with dimensions ``(time)`` and ``(time, component)``, and ``(time, particle, …)`` for
        the fields named in ``output.particle_history``.

    Raises:
        CaseError: the case cannot be run as it stands.
        GuardStop: the run diverged, or a plug-in raised an exception; everything up to then is in the run
            directory.
        OutputError: the run directory cannot be written, or another run is writing it.
    """
    require_memory(case)
    with blaming_plugins(case):
        simulation = Simulation(case)
    threads = use_threads(threads, len(simulation.particles))
    if out is None:
        recorder = Recorder(simulation, attributes(case, threads), None)
        _execute(recorder, threads, listen)
        return recorder.history.dataset()
    directory = RunDirectory(Path(out), overwrite)
    with directory.claimed(), open_log(directory.log):
        try:
            write_json(directory.case, resolved(case))
            recorder = Recorder(simulation, attributes(case, threads), directory)
        except OutputError as error:
            LOGGER.error("%s", error)
            raise
        try:
            _execute(recorder, threads, listen)
        except GuardStop:
            _report(case, directory)
            raise
        _report(case, directory)
    return recorder.history.dataset()


def _report(case: Case, directory: RunDirectory) -> None:
    """Draw the pictures. They can be drawn again from the directory: none is worth the outcome of a run."""
    if not case.output.report:
        return
    try:
        from .report import write_report

        write_report(directory.path)
    except Exception as error:
        LOGGER.warning("the report was not drawn: %s", reason(error), exc_info=True)


def _execute(recorder: Recorder, threads: int, listen: Listener | None) -> None:
    simulation, directory = recorder.simulation, recorder.directory
    case = simulation.case
    watch = Stopwatch()
    try:
        with blaming_plugins(case, lambda: (simulation.steps, simulation.time)):
            _announce(simulation, threads)
            _advance(simulation, recorder, watch, listen)
        conclude(recorder, "finished", watch.elapsed)
    except GuardStop as stop:
        LOGGER.error("%s", stop, exc_info=stop.__cause__)
        salvage(recorder, stop.guard, watch.elapsed)
        raise
    except KeyboardInterrupt:
        salvage(recorder, "interrupted", watch.elapsed)
        kept = "" if directory is None else f"; the results up to then are in '{directory.path}'"
        raise Interrupted(f"interrupted at t = {simulation.time:.6g} s{kept}") from None
    except OutputError as error:
        LOGGER.error("%s", error)
        salvage(recorder, "output-error", watch.elapsed)
        raise
    except Exception as error:
        LOGGER.error("%s", reason(error), exc_info=True)
        salvage(recorder, "error", watch.elapsed)
        raise


def _announce(simulation: Simulation, threads: int) -> None:
    limit = simulation.limits.as_dict().get(simulation.limited_by)
    share = (
        "" if limit is None else f" ({simulation.time_step / limit:.3g} of the {simulation.limited_by} limit)"
    )
    LOGGER.info(
        "%s: %d particles, step %.4g s%s, threads: %d",
        simulation.case.name, len(simulation.particles), simulation.time_step, share, threads,
    )  # fmt: skip
    for sentence in simulation.remarks():
        LOGGER.info("%s", sentence)
    for sentence in [*cautions(simulation.case), *simulation.warnings()]:
        LOGGER.warning("%s", sentence)


def _advance(simulation: Simulation, recorder: Recorder, watch: Stopwatch, listen: Listener | None) -> None:
    until = simulation.case.until
    recorder.record()
    simulation.advance(until)  # the first step loads or compiles the kernels: the clock starts behind it
    watch.start()
    told = clock.monotonic()
    recorder.record()
    warned = False
    while until - simulation.time > 1e-9 * until:
        simulation.advance(until - simulation.time)
        recorder.record()
        if simulation.mach_number > COMPRESSIBLE and not warned:
            warned = True
            LOGGER.warning(
                "the Mach number is %.3g at t = %.4g s: the material flows as if it were compressible; "
                "a larger sound_speed makes it less so",
                simulation.mach_number, simulation.time,
            )  # fmt: skip
        now = clock.monotonic()
        if listen is not None and now - told > TOLD_EVERY:
            told = now
            listen(_progress(simulation, watch.elapsed))
    simulation.check()
    if listen is not None:
        listen(_progress(simulation, watch.elapsed))


def _progress(simulation: Simulation, elapsed: float) -> Progress:
    until = simulation.case.until
    done = simulation.time / until
    speed = simulation.particle_steps / elapsed
    return Progress(simulation.time, until, simulation.steps, speed, elapsed * (1 - done) / done)
