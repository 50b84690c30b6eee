"""A source in a scene: the column of material behind its mouth, and the effect of the column on the nodes.

The column is a lattice of rows of length h, which moves with the velocity w of the source. Rows that can
reach a node in front of the mouth are mapped to the nodes as particles are, so that the part of a row that
has passed the mouth counts. Without these rows the material would end half a row, on average, in front of the
mouth, and its pressure would push it back whenever a row comes in. A row becomes particles when its middle
passes the mouth. These get the velocity w, and the density and the pressure of the material in front of the
mouth.

All nodes behind the mouth that the column reaches have the velocity w, after mapping and after the momentum
equation. So the material in front of the mouth can neither stop the column nor separate from it.
"""

from __future__ import annotations

import math

import numpy as np

from ..case.model import Case
from ..case.sources import row_length, section_of
from ..kernels.scatter import NODE, scatter
from ..kernels.vectors import LANES
from .grid import Grid, Window
from .particles import Particles
from .scene import fresh_particles, materials_of
from .stateful import State, restore_plain
from .tasks import TASKS

AT_MOUTH = 1e-6
"""A node up to this many cells in front of the mouth still counts as behind it."""
LEAST_MASS = 1e-9
"""Least mass of a node that the column reaches, relative to the largest: smaller ones are rounding."""
LIFTED = 8
"""Cells by which the column is shifted for the shape function, which needs positions above zero."""


class Feed:
    """The column of one source.

    Attributes:
        rows: number of rows that have come in.
        ratio: J of the next row to come in: that of the material in front of the mouth.
        mass_in: mass that has come in, kg.
        impulse: impulse of the column and of the nodes behind the mouth on the particles, N s, ``(dim,)``.
        work: work of this impulse at the speed of the column, J.
        mapped_mass: mass of the column at the nodes in the last step, kg.
    """

    def __init__(self, case: Case, name: str, number: int, grid: Grid, window: Window) -> None:
        """
        Args:
            case: a validated case with the source.
            name: name of the source.
            number: ``Particles.body`` of its particles.
            grid, window: the nodes.
        """
        one, dim = case.sources[name], grid.dim
        self._case, self._name, self._number = case, name, number
        self._grid, self._window = grid, window
        self._source, self._density = one.source, one.material.density
        self._group = materials_of(case).index(one.material)
        self._mouth, self._area = case.mouths[name], case.mouth_area(name)
        self._section, self._length = section_of(case, name), row_length(case, name)
        self._begins, self._ends = one.source.spell(self._area, self._density)
        half = self._section.width / 2
        half[self._mouth.axis] = self._length / 2
        self._half = np.minimum(half, grid.cell_size / 2)
        # Number of rows whose weights can reach beyond the mouth.
        self._depth = math.ceil((grid.cell_size + self._half[self._mouth.axis]) / self._length) + 1
        self._normal = np.zeros(dim)
        self._normal[self._mouth.axis] = self._mouth.sign
        self._scatter = scatter(dim, case.scheme.shape.support)
        self.rows, self.ratio, self.mass_in = 0, 1.0, 0.0
        self.impulse, self.work, self.mapped_mass = np.zeros(dim), 0.0, 0.0
        self._acts = False

    def state(self) -> State:
        """Sums of what has come in, and the mass of the column at the nodes in the last step."""
        return {
            name: np.array(getattr(self, name))
            for name in ("rows", "ratio", "mass_in", "impulse", "work", "mapped_mass")
        }

    def restore(self, state: State) -> None:
        """Restore the state."""
        restore_plain(self, state)

    # --- The column

    def pushed(self, time: float) -> float:
        """Length of the column that has been pushed out, m."""
        return self._source.pushed(time, self._area, self._density)

    def place(self, time: float) -> np.ndarray:
        """Displacement of the mouth, m, ``(dim,)``."""
        return np.array(np.broadcast_to(self._source.moved(time), self._normal.shape), dtype=float)

    def velocity(self, time: float, dt: float) -> np.ndarray:
        """Mean velocity w of the column in a step, m/s, ``(dim,)``."""
        moved = self.place(time + dt) - self.place(time)
        return (moved + self._normal * (self.pushed(time + dt) - self.pushed(time))) / dt

    def fastest(self, t0: float, t1: float) -> float:
        """Upper bound of the speed of the column between two times, m/s."""
        return self._case.source_speed(self._name, t0, t1)

    def goes_on(self, time: float) -> bool:
        """Whether it has not ended by a time, s."""
        return time < self._ends

    def _rows(self, numbers: np.ndarray, time: float, ratio: float) -> Particles:
        """Rows of the column, counted from the first one, as particles with the volume ratio J."""
        section = self._section
        middle = self.pushed(time) - (numbers + 0.5) * self._length
        position = section.position - self._grid.lower + self.place(time)
        position = (position + middle[:, None, None] * self._normal).reshape(-1, len(self._normal))
        n = len(position)
        volume = np.tile(section.area, len(numbers)) * self._length
        found = fresh_particles(
            self._case,
            number=np.zeros(n, dtype=np.int64),
            body=np.full(n, self._number, dtype=np.int32),
            position=position,
            velocity=np.zeros_like(position),
            density=np.full(n, self._density),
            volume=volume,
            half_size=np.tile(self._half, (n, 1)),
        )
        found.volume_ratio[:] = ratio
        found.volume *= ratio
        return found

    # --- A step

    def begin(self, time: float, dt: float, particles: Particles, active: np.ndarray) -> None:
        """Find the rows behind the mouth, their weights, and the nodes that they reach, before a step.

        Args:
            time: start of the step, s.
            dt: its length, s.
            particles: all particles of the scene.
            active: whether each node of the window can be reached by particles.
        """
        self._acts = self._begins <= time < self._ends
        self.mapped_mass = 0.0
        if not self._acts:
            return
        self._dt, self._w = dt, self.velocity(time, dt)
        self._column = self._rows(self.rows + np.arange(self._depth), time, self.ratio)
        self._column.velocity[:] = self._w
        group = particles.groups[self._group]
        self._column.pressure[:] = group.pressure(self._column.volume_ratio)
        self._evaluate()
        self._find_nodes(time, active)

    def _evaluate(self) -> None:
        """Weights of the rows, and the block of nodes around them."""
        c, shape, dx = self._column, self._case.scheme.shape, self._grid.cell_size
        n, dim = c.position.shape
        radial = self._case.space_.radial
        lift = np.full(dim, LIFTED)
        lift[0] = 0 if radial else LIFTED
        position = c.position + lift * dx
        self._base = np.zeros((n, dim), dtype=np.int32)
        self._weight, self._gradient = np.zeros((2, n, dim, shape.support))
        self._hoop = np.zeros((n, shape.support if radial else 0))
        if radial:
            tables = self._base[:, 0], self._weight[:, 0], self._gradient[:, 0]
            shape.fill_radial(position[:, 0], c.half_size[:, 0], dx, *tables, self._hoop)
            along = self._base[:, 1:], self._weight[:, 1:], self._gradient[:, 1:]
            shape.fill(position[:, 1:], c.half_size[:, 1:], dx, *along)
        else:
            shape.fill(position, c.half_size, dx, self._base, self._weight, self._gradient)
        self._base -= lift.astype(np.int32)
        self._first = self._base.min(axis=0).astype(np.int64)
        size = self._base.max(axis=0) - self._first + shape.support
        self._shape = tuple(int(k) for k in size)
        self._strides = (
            (self._shape[1] * self._shape[2], self._shape[2], 1) if dim == 3 else (self._shape[1], 1, 1)
        )
        self._tasks = np.zeros((1, 1, TASKS + 1), dtype=np.int64)
        self._tasks[0, 0, 1:] = n

    def _find_nodes(self, time: float, active: np.ndarray) -> None:
        """Find the nodes of the block that particles can reach, and which of them move with the column."""
        mapped = self._map(momentum=True, forces=False, acceleration=np.zeros((1, self._grid.dim)))
        number = np.indices(self._shape).reshape(len(self._shape), -1).T + self._first
        inside = number - self._window.lower
        held = ((inside >= 0) & (inside < np.array(self._window.shape[: self._grid.dim]))).all(axis=1)
        index = np.where(held, inside @ np.array(self._window.strides[: self._grid.dim]), 0)
        held &= active[index] & (mapped[:, 0] > 0)
        self._local, self._index = np.flatnonzero(held), index[held]
        axis = self._mouth.axis
        plane = self._mouth.centre[axis] - self._grid.lower[axis] + self.place(time)[axis]
        before = self._mouth.sign * (number[held, axis] * self._grid.cell_size - plane)
        reached = mapped[held, 0] > LEAST_MASS * mapped[:, 0].max()
        self._carried = np.flatnonzero((before <= AT_MOUTH * self._grid.cell_size) & reached)
        self._mass = mapped[held, 0]
        self._momentum = mapped[held, 1 : 1 + self._grid.dim]
        self._force = np.zeros_like(self._momentum)

    def _map(self, momentum: bool, forces: bool, acceleration: np.ndarray) -> np.ndarray:
        """Mass, momentum and force that the rows add to the nodes of their block, ``(nodes, NODE)``."""
        c = self._column
        nodes = np.zeros((int(np.prod(self._shape)) + LANES, NODE))
        self._scatter(
            nodes, self._strides, self._first, self._tasks, self._base, self._weight, self._gradient,
            self._hoop, c.mass, c.velocity, c.affine, c.volume, c.stress, c.pressure, acceleration,
            self._grid.cell_size, momentum, forces,
        )  # fmt: skip
        return nodes[:-LANES]

    def map(self, momentum: bool, forces: bool, acceleration: np.ndarray) -> None:
        """Add the rows to the nodes, after the particles, with an acceleration, m/s², ``(1, dim)``."""
        if not self._acts:
            return
        dim = self._grid.dim
        mapped = self._map(momentum, forces, acceleration)[self._local]
        if forces:
            self._force = mapped[:, 1 + dim : 1 + 2 * dim]
        if momentum:
            self.mapped_mass = float(mapped[:, 0].sum())
        self._window.nodes[self._index, : 1 + 2 * dim] += mapped[:, : 1 + 2 * dim]

    def carry(self, dt: float | None) -> None:
        """Give the nodes behind the mouth the velocity of the column: after mapping, or after the momentum
        equation of a step of ``dt`` s."""
        if not self._acts:
            return
        dim, nodes = self._grid.dim, self._window.nodes
        velocity, change = slice(1, 1 + dim), slice(1 + dim, 1 + 2 * dim)
        index = self._index[self._carried]
        mass, missing = nodes[index, :1], self._w - nodes[index, velocity]
        nodes[index, velocity] += missing
        given = (mass * missing).sum(axis=0)
        if dt is None:
            moved = self._mass[:, None] * nodes[self._index, velocity] - self._momentum
            self._mapped = given - moved.sum(axis=0)
        else:
            nodes[index, change] += missing
            moved = dt * self._force - self._mass[:, None] * nodes[self._index, change]
            self._solved = given + moved.sum(axis=0)

    def taken_up(self, flip: float) -> None:
        """Add up the impulse and the work that reach the particles, see ``Operations.move_particles``."""
        if not self._acts:
            return
        given = self._solved + (1 - flip) * self._mapped
        self.impulse += given
        self.work += float(given @ self._w)

    # --- New particles

    def due(self, time: float, dt: float) -> bool:
        """Whether a row has passed the mouth at a time, s, after a step of ``dt`` s."""
        return time >= self._begins and time - dt < self._ends and self._through(time) > self.rows

    def _through(self, time: float) -> int:
        """Number of rows whose middle has passed the mouth."""
        return math.floor(self.pushed(min(time, self._ends)) / self._length + 0.5 + AT_MOUTH)

    def enter(self, time: float, dt: float, particles: Particles) -> None:
        """Add the rows that have passed the mouth at a time, s, after a step of ``dt`` s."""
        if not self.due(time, dt):
            return
        through = self._through(time)
        group = particles.groups[self._group]
        self.ratio = self._ratio_before(particles, time)
        new = self._rows(np.arange(self.rows, through), time, self.ratio)
        new.velocity[:] = self.velocity(time - dt, dt)
        new.pressure[:] = new.mapped_pressure[:] = group.pressure(new.volume_ratio)
        new.number[:] = particles.new_numbers(len(new))
        self.rows = through
        self.mass_in += float(new.mass.sum())
        particles.add(self._group, new)

    def _ratio_before(self, particles: Particles, time: float) -> float:
        """Mean J of the material within a cell in front of the mouth; 1 if there is none."""
        part, mouth, dx = particles.groups[self._group].part, self._mouth, self._grid.cell_size
        middle = np.array(mouth.centre) - self._grid.lower + self.place(time)
        apart = particles.position[part] - middle
        before = mouth.sign * apart[:, mouth.axis]
        half = np.array(mouth.half_width)
        half[mouth.axis] = np.inf
        near = (before >= 0) & (before < dx) & (np.abs(apart) < half).all(axis=1)
        volume = particles.initial_volume[part][near]
        if not len(volume):
            return 1.0
        return float(volume @ particles.volume_ratio[part][near] / volume.sum())
