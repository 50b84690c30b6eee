"""The records of a run: rows of the history and frames, at the times given by the case."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..case.diagnostics import diagnostic_columns
from ..case.draining import drain_columns
from ..case.forces import force_columns
from ..case.model import Case
from ..case.output import FRAMES, ROWS
from ..case.sources import source_columns
from ..case.state_variables import particle_variables
from ..output import FrameWriter, History, RunDirectory, Variable
from ..output.columns import COLUMNS, ledger_columns, wall_columns
from ..output.flow import arrays_of, write_flow
from ..solver.ledger import CAUSES, ENERGY, MASS
from ..solver.particle_fields import frame_fields, history_fields
from ..solver.simulation import Simulation
from ..solver.stateful import State, Stateful, plain_state, restore, restore_plain, state_of
from .ending import Ending
from .flow_record import LOOKS, FlowRecord
from .measuring import measurements
from .milestones import Milestones
from .schedule import Schedule
from .wall_frames import WallFrames


def measurement_columns(case: Case) -> tuple[Variable, ...]:
    """The columns of the measurements of a case."""
    return tuple(Variable(name, m.unit, m.description) for name, m in case.measurements.items())


class Recorder:
    """Adds to the history of a simulation, and to its frames if it has a run directory.

    A row or a frame shows the end of the step nearest to its time; no step is shortened for it.
    """

    def __init__(
        self,
        simulation: Simulation,
        attributes: dict[str, Any],
        directory: RunDirectory | None,
        goes_on: bool = False,
    ) -> None:
        """
        Args:
            simulation: the simulation that is recorded.
            attributes: global attributes of the history.
            directory: for the history and the frames; without one, nothing is written.
            goes_on: whether ``restore`` is called next; existing frames are kept until then.
        """
        case = simulation.case
        settings, end = case.output, case.end
        self.simulation = simulation
        self.directory = directory
        variables = particle_variables(case)
        axes, walls = case.space_.axes, simulation.wall_names
        columns = (
            *COLUMNS,
            *source_columns(case),
            *force_columns(case),
            *drain_columns(case),
            *diagnostic_columns(case),
            *measurement_columns(case),
            *ledger_columns(CAUSES),
            *(wall_columns(axes) if walls else ()),
        )
        self.history = History(columns, attributes, axes, variables, walls)
        self._wall_sums, self._sunk = simulation.wall_sums(), simulation.ledger.mass_out.copy()
        self._fed = simulation.operations.sources.mass_in
        self._worked = simulation.force_work.copy()
        self._since = simulation.time
        self.frames = None if directory is None else FrameWriter(directory.frames, case.space_, goes_on)
        self.wall_frames = None if directory is None else WallFrames(case, directory.frames, goes_on)
        self.flow = FlowRecord(simulation) if directory is not None and settings.report else None
        self._rows_due = Schedule(settings.history_interval or end / ROWS, end)
        self._frames_due = Schedule(settings.frame_interval or end / FRAMES, end, settings.snapshot_times)
        self._flow_due = Schedule(end / LOOKS, end, settings.snapshot_times)
        self.milestones = Milestones(simulation)
        self.ending = Ending(simulation, self.milestones)
        self._last_row = self._last_frame = -1  # steps

    def record(self) -> None:
        """Add a row and a frame if they are due, and check for milestones and for the end."""
        self.milestones.watch()
        self.ending.watch()
        now = self.simulation.time + 0.5 * self.simulation.time_step
        if self._rows_due.passed(now):
            self.add_last_row()
        if self.frames is not None and self._frames_due.passed(now):
            self.add_last_frame()
        if self.flow is not None and self._flow_due.passed(now):
            self.flow.look(self.simulation)

    @property
    def components(self) -> dict[str, Stateful]:
        """The components with a state."""
        found: dict[str, Stateful] = {
            "history": self.history,
            "milestones": self.milestones,
            "ending": self.ending,
            "rows_due": self._rows_due,
            "frames_due": self._frames_due,
            "flow_due": self._flow_due,
        }
        if self.flow is not None:
            found["flow"] = self.flow
        if self.frames is None or self.wall_frames is None:
            return found
        return found | {"frames": self.frames, "wall_frames": self.wall_frames}

    def state(self) -> State:
        """The records so far, and the next times."""
        return plain_state(self) | state_of(self.components)

    def restore(self, state: State) -> None:
        """Restore the records up to the present step of the simulation."""
        restore_plain(self, state)
        restore(self.components, state)

    def add_last_row(self) -> None:
        """Add a row of the present step if there is none."""
        if self._last_row != self.simulation.steps:
            self._add_row()

    def add_last_frame(self) -> None:
        """Add a frame of the present step if there is none."""
        if self.frames is not None and self._last_frame != self.simulation.steps:
            self._add_frame()

    def add_last_moment(self) -> None:
        """Add the present step to the flow if it is missing."""
        if self.flow is not None:
            self.flow.add(self.simulation)

    def write(self) -> None:
        """Write the history and the flow."""
        if self.directory is not None:
            self.history.write(self.directory.history)
        self._write_flow()

    def _write_flow(self) -> None:
        if self.directory is not None and self.flow is not None:
            write_flow(self.directory.flow, arrays_of(self.flow.moments))

    def _add_row(self) -> None:
        simulation, particles = self.simulation, self.simulation.particles
        account = simulation.account()
        values = simulation.measured() | {
            "ledger_mass": account[:, MASS],
            "ledger_momentum": account[:, 1:-1],
            "ledger_energy": account[:, ENERGY],
        }
        passed, self._since = simulation.time - self._since, simulation.time
        if simulation.case.sources:
            values |= self._source_means(passed)
        if simulation.case.varying_forces:
            values |= self._force_means(passed)
        if simulation.case.sinks:
            values |= self._sink_means(passed)
        if simulation.wall_names:
            values |= self._wall_means(passed)
        values |= measurements(simulation, values)
        with simulation.blaming:
            kept = history_fields(simulation)
        fields = {name: _by_number(field, particles.number) for name, field in kept.items()}
        self.history.record(simulation.time, values, fields)
        self._last_row = simulation.steps
        if self.directory is not None and self.history.flush_if_due(self.directory.history):
            self._write_flow()

    def _source_means(self, passed: float) -> dict[str, np.ndarray]:
        """Mass brought in by each source, and its rate: the mean over the time since the last row, s."""
        mass = self.simulation.operations.sources.mass_in
        rate = (mass - self._fed) / passed if passed > 0 else np.zeros_like(mass)
        self._fed = mass
        return {"source_mass": mass, "source_rate": rate}

    def _force_means(self, passed: float) -> dict[str, np.ndarray]:
        """Work of each force, and its power: the mean over the time since the last row, s."""
        work = self.simulation.force_work.copy()
        power = (work - self._worked) / passed if passed > 0 else np.zeros_like(work)
        self._worked = work
        return {"force_work": work, "force_power": power}

    def _sink_means(self, passed: float) -> dict[str, np.ndarray]:
        """Mass removed by each sink, and its rate: the mean over the time since the last row, s."""
        mass = self.simulation.ledger.mass_out.copy()
        rate = (mass - self._sunk) / passed if passed > 0 else np.zeros_like(mass)
        self._sunk = mass
        return {"sink_mass": mass, "sink_rate": rate}

    def _wall_means(self, passed: float) -> dict[str, np.ndarray]:
        """Force, torque and power of each wall, means over the time since the last row, s."""
        sums = self.simulation.wall_sums()
        mean = (sums - self._wall_sums) / passed if passed > 0 else np.zeros_like(sums)
        self._wall_sums = sums
        dim = self.simulation.grid.dim
        return {"wall_force": mean[:, :dim], "wall_torque": mean[:, dim:-1], "wall_power": mean[:, -1]}

    def _add_frame(self) -> None:
        assert self.frames is not None
        assert self.wall_frames is not None
        simulation, particles = self.simulation, self.simulation.particles
        position = particles.position + simulation.grid.lower
        with simulation.blaming:
            fields = frame_fields(simulation)
        self.frames.write(simulation.time, simulation.steps, fields, position)
        with simulation.blaming:
            self.wall_frames.add(simulation.time, simulation.steps)
        self._last_frame = simulation.steps


def _by_number(field: np.ndarray, number: np.ndarray) -> np.ndarray:
    """A field with a row for every number up to the largest; NaN for particles that no longer exist."""
    if len(number) == number.max(initial=-1) + 1:
        return field[np.argsort(number)]
    found = np.full((int(number.max(initial=-1)) + 1, *field.shape[1:]), np.nan)
    found[number] = field
    return found
