"""A run from its present state to its end: steps, rows, frames and checkpoints, and how it may end before."""

from __future__ import annotations

import logging
import shlex
import time as clock
from collections.abc import Callable
from dataclasses import dataclass

from ..case.forewarnings import forewarnings
from ..case.plugins import cautions, plugins_of
from ..errors import GuardStop, Interrupted, MpmkitError, OutputError, reason
from ..registry.blame import blaming_plugins
from ..solver.simulation import Simulation
from .conclusion import conclude, salvage
from .interrupts import held_interrupts
from .recorder import Recorder
from .saver import Saver
from .stopwatch import Stopwatch

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


class _HeldInterrupt(KeyboardInterrupt):
    """An interrupt that waited for the end of a step: the state is whole."""


def execute(
    recorder: Recorder, watch: Stopwatch, threads: int, listen: Listener | None, saver: Saver | None
) -> None:
    """Advance the simulation of a recorder to its end, and write how it ended.

    Raises:
        GuardStop: it diverged, or a plug-in raised an exception.
        OutputError: something could not be written.
        Interrupted: on Ctrl-C or SIGTERM; a checkpoint is written if the state is whole.
    """
    simulation = recorder.simulation
    try:
        with blaming_plugins(plugins_of(simulation.case), lambda: (simulation.steps, simulation.time)):
            _announce(simulation, threads)
            _advance(recorder, watch, listen, saver)
        conclude(recorder, "finished", watch.elapsed)
        if saver is not None:
            saver.remove()
    except GuardStop as stop:
        LOGGER.error("%s", stop, exc_info=stop.__cause__)
        salvage(recorder, stop.guard, watch.elapsed)
        raise
    except KeyboardInterrupt as stop:
        saved = isinstance(stop, _HeldInterrupt) and _save_at_last(saver)
        salvage(recorder, "interrupted", watch.elapsed)
        raise Interrupted(_interrupted(recorder, saved)) from None
    except OutputError as error:
        LOGGER.error("%s", error)
        salvage(recorder, "output-error", watch.elapsed)
        raise
    except Exception as error:
        LOGGER.error("%s", reason(error), exc_info=True)
        salvage(recorder, "error", watch.elapsed)
        raise


def _save_at_last(saver: Saver | None) -> bool:
    """Write a checkpoint if there is somewhere to; whether it was written."""
    if saver is None:
        return False
    try:
        saver.save()
    except MpmkitError as error:
        LOGGER.warning("no checkpoint: %s", error)
        return False
    return True


def _interrupted(recorder: Recorder, saved: bool) -> str:
    at = f"interrupted at t = {recorder.simulation.time:.6g} s"
    if recorder.directory is None:
        return at
    path = recorder.directory.path
    more = f"; go on with: mpmkit run --resume {shlex.quote(str(path))}" if saved else ""
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
    for sentence in simulation.remarks():
        LOGGER.info("%s", sentence)
    case = simulation.case
    for sentence in [*cautions(case), *forewarnings(case), *simulation.warnings()]:
        LOGGER.warning("%s", sentence)


def _advance(recorder: Recorder, watch: Stopwatch, listen: Listener | None, saver: Saver | None) -> None:
    simulation = recorder.simulation
    until = simulation.case.until
    recorder.record()
    simulation.advance(until - simulation.time)  # loads or compiles the kernels: the clock starts behind it
    watch.start()
    told = clock.monotonic()
    recorder.record()
    warned = False
    with held_interrupts() as interrupted:
        while until - simulation.time > 1e-9 * until:
            simulation.advance(until - simulation.time)
            recorder.record()
            if interrupted():
                raise _HeldInterrupt
            if saver is not None:
                saver.save_if_due()
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
