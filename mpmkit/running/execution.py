"""A run from its present state to its end: steps, rows, frames, checkpoints, and early ends."""

from __future__ import annotations

import logging
import shlex
import time as clock
from collections.abc import Callable
from dataclasses import dataclass

from ..case.ending import conditions
from ..case.forewarnings import forewarnings
from ..case.plugins import cautions, plugins_of
from ..errors import GuardStop, Interrupted, OutputError, reason
from ..output.checkpoints import Checkpoints
from ..output.summary import FINISHED
from ..registry.blame import blaming_plugins
from ..solver.density_watch import warning
from ..solver.simulation import Simulation
from .conclusion import conclude, salvage
from .interrupts import held_interrupts
from .pace import Pace
from .recorder import Recorder
from .saver import Saver
from .setting import setting
from .stopwatch import Stopwatch

LOGGER = logging.getLogger("mpmkit")
COMPRESSIBLE = 0.1
"""Mach number above which the density may change by more than half a percent as the material flows."""
TOLD_EVERY = 0.2
"""Seconds between two calls of a listener."""


@dataclass(frozen=True)
class Progress:
    """Data for a progress display, a few times per second."""

    time: float
    until: float
    """s, latest end of the run"""
    ends_earlier: bool
    """whether it may end earlier"""
    steps: int
    particle_steps_per_second: float
    seconds_left: float


Listener = Callable[[Progress], None]


class _HeldInterrupt(KeyboardInterrupt):
    """An interrupt that waited for the end of a step: the state is complete."""


def execute(
    recorder: Recorder, watch: Stopwatch, threads: int, listen: Listener | None, saver: Saver | None
) -> bool:
    """Advance the simulation of a recorder to its end, and write how it ended.

    Returns:
        Whether an interrupt came too late to stop the run; the remaining work should then be short.

    Raises:
        GuardStop: it diverged, or a plug-in raised an exception.
        OutputError: something could not be written.
        Interrupted: on Ctrl-C or SIGTERM and the like; a checkpoint is written if the state is whole.
    """
    simulation = recorder.simulation
    try:
        with blaming_plugins(plugins_of(simulation.case), lambda: (simulation.steps, simulation.time)):
            _announce(simulation, threads)
            _first_step(recorder, saver)
        watch.start()
        with held_interrupts() as interrupted:
            with blaming_plugins(plugins_of(simulation.case), lambda: (simulation.steps, simulation.time)):
                _advance(recorder, watch, listen, saver, interrupted)
            conclude(recorder, recorder.ending.ended or FINISHED, watch.elapsed)
            if saver is not None:
                saver.keep_last()
            return interrupted()
    except GuardStop as stop:
        LOGGER.error("%s", stop, exc_info=stop.__cause__)
        salvage(recorder, stop.guard, watch.elapsed)
        raise
    except KeyboardInterrupt as stop:
        if isinstance(stop, _HeldInterrupt) and saver is not None:
            saver.save_if_possible()
        salvage(recorder, "interrupted", watch.elapsed)
        raise Interrupted(_interrupted(recorder)) from None
    except OutputError as error:
        LOGGER.error("%s", error)
        salvage(recorder, "output-error", watch.elapsed)
        raise
    except Exception as error:
        LOGGER.error("%s", reason(error), exc_info=True)
        salvage(recorder, "error", watch.elapsed)
        raise


def _interrupted(recorder: Recorder) -> str:
    at = f"interrupted at t = {recorder.simulation.time:.6g} s"
    if recorder.directory is None:
        return at
    path = recorder.directory.path
    can_go_on = Checkpoints(recorder.directory.checkpoints).paths()
    more = f"; go on with: mpmkit run --resume {shlex.quote(str(path))}" if can_go_on else ""
    return f"{at}; the results up to then are in '{path}'{more}"


def _announce(simulation: Simulation, threads: int) -> None:
    limit = simulation.limits.as_dict().get(simulation.limited_by)
    share = (
        "" if limit is None else f" ({simulation.time_step / limit:.3g} of the {simulation.limited_by} limit)"
    )
    LOGGER.info(
        "%s: %d particles, step %.4g s%s, threads: %d",
        simulation.case.name, len(simulation.particles), simulation.time_step, share, threads,
    )  # fmt: skip
    if simulation.steps > 0:
        LOGGER.info("goes on after step %d, t = %.6g s", simulation.steps, simulation.time)
    for sentence in [*setting(simulation.case), *simulation.remarks()]:
        LOGGER.info("%s", sentence)
    case = simulation.case
    for sentence in [*cautions(case), *forewarnings(case), *simulation.warnings()]:
        LOGGER.warning("%s", sentence)


def _first_step(recorder: Recorder, saver: Saver | None) -> None:
    """Load or compile the kernels; this does not count as wall time, and an interrupt ends it at once."""
    if not _over(recorder):  # true for a run whose last checkpoint is of its last step
        recorder.record()
        _step(recorder, saver)


def _advance(
    recorder: Recorder,
    watch: Stopwatch,
    listen: Listener | None,
    saver: Saver | None,
    interrupted: Callable[[], bool],
) -> None:
    simulation = recorder.simulation
    told, pace = clock.monotonic(), Pace()
    pace.note(told, simulation.time)
    warned = warned_of_density = False
    while not _over(recorder):
        if interrupted():
            raise _HeldInterrupt
        if saver is not None:
            saver.save_if_due()
        _step(recorder, saver)
        if simulation.mach_number > COMPRESSIBLE and not warned:
            warned = True
            LOGGER.warning(
                "the Mach number is %.3g at t = %.4g s: the material flows as if it were compressible; "
                "a larger sound_speed makes it less so",
                simulation.mach_number, simulation.time,
            )  # fmt: skip
        if simulation.guards.density.noted and not warned_of_density:
            warned_of_density = True
            LOGGER.warning("%s", warning(simulation, simulation.guards.density))
        now = clock.monotonic()
        if listen is not None and now - told > TOLD_EVERY:
            told = now
            pace.note(now, simulation.time)
            if pace.known:
                listen(_progress(simulation, watch.elapsed, pace))
    simulation.check()
    if listen is not None:
        listen(_progress(simulation, watch.elapsed, pace))


def _over(recorder: Recorder) -> bool:
    time, end = recorder.simulation.time, recorder.simulation.case.end
    return bool(recorder.ending.ended) or not end - time > 1e-9 * end


def _step(recorder: Recorder, saver: Saver | None) -> None:
    """One step with its records, and the last checkpoint, from which the run can be made longer.

    The last step is shortened to end with the run. A longer run does not shorten it and continues from before
    it.
    """
    simulation = recorder.simulation
    simulation.prepare()
    left = simulation.case.end - simulation.time
    cut = simulation.time_step > left
    if cut and saver is not None and simulation.steps > 0:
        saver.save_if_possible()
    simulation.advance(left)
    recorder.record()
    if not cut and saver is not None and _over(recorder):
        saver.save_if_possible()


def _progress(simulation: Simulation, elapsed: float, pace: Pace) -> Progress:
    end = simulation.case.end
    speed = simulation.particle_steps / elapsed
    earlier, left = bool(conditions(simulation.case.until)), pace.left(end - simulation.time)
    return Progress(simulation.time, end, earlier, simulation.steps, speed, left)
