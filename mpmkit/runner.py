"""A whole run: advance a case to its end and write what it did, in memory or into a run directory."""

from __future__ import annotations

import json
import logging
import platform
import time as clock
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numba
import numpy as np

from . import __version__
from .case.model import Case
from .errors import GuardStop, MpmkitError
from .memory import require_memory
from .output import FrameWriter, History, RunDirectory, Variable, open_log, summarise
from .registry import installed
from .schedule import Schedule, frame_schedule, history_schedule
from .solver.measures import PARTICLE_FIELDS, frame_fields
from .solver.simulation import Simulation

if TYPE_CHECKING:
    import xarray

LOGGER = logging.getLogger("mpmkit")
ROWS = 400
"""Rows of a history whose interval is not given."""
FRAMES = 20
"""Frames of a run whose interval is not given."""
PARTICLES_PER_THREAD = 4000
"""Below this a second thread costs more in waiting than it saves."""

COLUMNS = (
    Variable("spread_diameter", "m", "diameter of the material on the floor, mean over the horizontal axes"),
    Variable("height", "m", "largest height of the material above the floor of the grid"),
    Variable("axis_height", "m", "height of the material within one cell of its axis"),
    Variable("slump", "m", "initial height minus height on the axis"),
    Variable("kinetic_energy", "J", "kinetic energy of the particles"),
    Variable("potential_energy", "J", "potential energy in gravity, zero at the origin"),
    Variable("strain_energy", "J", "elastic energy of the laws that have one"),
    Variable("compressive_energy", "J", "energy stored by the equation of state"),
    Variable("total_mass", "kg", "mass of all particles"),
    Variable("momentum", "kg m/s", "momentum of all particles", component=True),
    Variable("max_speed", "m/s", "largest particle speed"),
    Variable("time_step", "s", "length of the time step"),
)


@dataclass
class Progress:
    """What a progress display is told, a few times a second."""

    time: float
    until: float
    steps: int
    particle_steps_per_second: float
    seconds_left: float


Listener = Callable[[Progress], None]


@dataclass
class Run:
    """A run in progress: its simulation, its history and where it writes."""

    simulation: Simulation
    directory: RunDirectory | None
    history: History
    frames: FrameWriter | None
    rows_due: Schedule
    frames_due: Schedule
    started: float = field(default_factory=clock.monotonic)

    def record(self) -> None:
        """Add a row, and a frame, if they are due."""
        simulation = self.simulation
        now, half_step = simulation.time, 0.5 * simulation.time_step
        if self.rows_due.passed(now + half_step):
            self._add_row()
        if self.frames is not None and self.frames_due.passed(now + half_step):
            self._add_frame()

    def close(self) -> None:
        """Record the state in which the run ended, however it ended."""
        if not self.rows_due.last == self.simulation.steps:
            self._add_row()
        if self.frames is not None and not self.frames_due.last == self.simulation.steps:
            self._add_frame()
        if self.directory is not None:
            self.history.write(self.directory.history)

    def _add_row(self) -> None:
        simulation = self.simulation
        particles = simulation.particles
        values = simulation.measures(particles) | {"time_step": simulation.time_step}
        kept = simulation.case.output.particle_history
        order = np.argsort(particles.number) if kept else None
        fields = {name: PARTICLE_FIELDS[name](particles, simulation.grid)[order] for name in kept}
        self.history.record(simulation.time, values, fields)
        self.rows_due.last = simulation.steps
        if self.directory is not None:
            self.history.flush_if_due(self.directory.history)

    def _add_frame(self) -> None:
        simulation = self.simulation
        particles = simulation.particles
        position = particles.position + simulation.grid.lower
        self.frames.write(simulation.time, simulation.steps, frame_fields(particles), position)
        self.frames_due.last = simulation.steps

    def advance(self, listen: Listener | None = None) -> None:
        """Advance to the end of the case, recording what is due."""
        simulation, until = self.simulation, self.simulation.case.until
        told, tick = clock.monotonic(), 0
        self.record()
        while until - simulation.time > 1e-9 * until:
            simulation.advance(until - simulation.time)
            self.record()
            tick += 1
            if listen is not None and tick % 10 == 0 and clock.monotonic() - told > 0.2:
                told = clock.monotonic()
                listen(self.progress())
        simulation.check()
        if listen is not None:
            listen(self.progress())

    def progress(self) -> Progress:
        simulation, until = self.simulation, self.simulation.case.until
        elapsed = max(clock.monotonic() - self.started, 1e-9)
        done = simulation.time / until
        left = elapsed * (1 - done) / done if done > 0 else float("nan")
        speed = simulation.steps * len(simulation.particles) / elapsed
        return Progress(simulation.time, until, simulation.steps, speed, left)


def use_threads(threads: int | None, particles: int) -> int:
    """Set the number of threads: as told, or as many as the particles can keep busy. Returns it."""
    most = numba.config.NUMBA_NUM_THREADS
    wanted = threads if threads is not None else max(1, particles // PARTICLES_PER_THREAD)
    chosen = min(most, max(1, wanted))
    numba.set_num_threads(chosen)
    return chosen


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
        GuardStop: the run diverged; everything up to then is in the run directory.
        OutputError: the run directory cannot be written.
    """
    require_memory(case)
    directory = None if out is None else RunDirectory(Path(out), overwrite)
    simulation = Simulation(case)
    if directory is None:
        return _execute(simulation, None, threads, listen)
    directory.claim()
    with open_log(directory.log):
        directory.write_json(directory.case, case.model_dump(mode="json"))
        return _execute(simulation, directory, threads, listen)


def _execute(
    simulation: Simulation, directory: RunDirectory | None, threads: int | None, listen: Listener | None
) -> xarray.Dataset:
    case = simulation.case
    threads = use_threads(threads, len(simulation.particles))
    history = History(COLUMNS, _attributes(case, threads), case.space_.axes)
    frames = None if directory is None else FrameWriter(directory.frames, case.space_)
    this = Run(simulation, directory, history, frames, history_schedule(case, ROWS), frame_schedule(case, FRAMES))
    LOGGER.info(
        "%s: %d particles, step %.4g s (%.3g of the %s limit), %d threads", case.name, len(simulation.particles),
        simulation.time_step, case.scheme.time_step.fraction, simulation.limited_by, threads,
    )  # fmt: skip
    for sentence in simulation.warnings():
        LOGGER.warning("%s", sentence)
    ended = "finished"
    try:
        this.advance(listen)
    except GuardStop as stop:
        ended = stop.guard
        LOGGER.error("%s", stop)
        raise
    except KeyboardInterrupt:
        ended = "interrupted"
        raise
    except MpmkitError:
        ended = "error"
        raise
    finally:
        history.attributes["stopped_because"] = ended
        if ended != "error":  # what could not be written once is not tried again
            this.close()
            if directory is not None:
                _write_summary(this, directory, ended)
    if directory is not None and case.output.report:
        from .report import write_report

        write_report(directory.path)
    return history.dataset()


def _write_summary(this: Run, directory: RunDirectory, ended: str) -> None:
    simulation = this.simulation
    summary = summarise(
        this.history.dataset(),
        particles=len(simulation.particles),
        steps=simulation.steps,
        wall_time=clock.monotonic() - this.started,
        stopped_because=ended,
        plugins=_plugins_used(simulation.case),
    )
    directory.write_json(directory.summary, summary)
    LOGGER.info("%s after %d steps, t = %.6g s", ended, simulation.steps, simulation.time)


def _plugins_used(case: Case) -> list[dict[str, str]]:
    """Every plug-in that the case uses, with the distribution and version that it came from."""
    scheme = case.scheme
    used = [("shape", scheme.shape), ("order", scheme.order), ("velocity", scheme.velocity)]
    used.append(("volumetric", scheme.volumetric))
    for body in case.bodies:
        used.append(("law", body.material.constitutive_law))
        if body.material.constitutive_law.uses_equation_of_state:
            used.append(("equation_of_state", body.material.equation_of_state))
    found = []
    for kind, plugin in used:
        origin = installed().plugins[kind].get(plugin.name)
        entry = {"kind": kind, "name": plugin.name}
        if origin is not None:
            entry |= {"distribution": origin.distribution, "version": origin.version}
        if entry not in found:
            found.append(entry)
    return found


def _attributes(case: Case, threads: int) -> dict[str, str]:
    """Global attributes: enough to know what was run, with what, and where."""
    versions: dict[str, Any] = {"mpmkit": __version__, "numpy": np.__version__, "numba": numba.__version__}
    machine = {
        "platform": platform.platform(),
        "processor": platform.processor() or platform.machine(),
        "python": platform.python_version(),
        "threads": threads,
    }
    return {
        "title": case.name,
        "case": json.dumps(case.model_dump(mode="json")),
        "versions": json.dumps(versions),
        "plugins": json.dumps(_plugins_used(case)),
        "machine": json.dumps(machine),
    }
