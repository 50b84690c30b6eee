"""The operations of a step on one scene; implements the contract ``Operations``."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..case.model import Case
from ..contracts.operations import Weighting
from ..contracts.version1 import operations_for
from ..errors import PluginFault
from ..kernels import domains, nodes, tensors, volumes
from ..kernels.gather import gather
from ..kernels.scatter import scatter
from ..registry import audit
from .averager import Averager
from .forces import Forces
from .grid import Grid, Window
from .particles import Group, Particles
from .redistribution import Stage
from .relaxation import Relaxation
from .sorting import Sorting
from .sources import Sources
from .stateful import State, Stateful, plain_state, restore, restore_plain, state_of
from .touch import Touch
from .walls import Faces, Walls

WIDEST = 9
"""Doubles of the widest array of the particles, a tensor."""
FILLED_ANEW = ("base", "weight", "gradient", "hoop", "_tables", "_rate", "_no_rows")
"""Arrays made from the case, or filled by a step before it reads them; weights are saved separately."""


class SceneOperations:
    """The operations of one step. Shape functions are evaluated in ``begin`` and used in the whole step."""

    def __init__(self, case: Case, grid: Grid, particles: Particles) -> None:
        dim, scheme = grid.dim, case.scheme
        radial = case.space_.radial
        self.scheme = scheme
        self.grid = grid
        self.cell_size = grid.cell_size
        self.particles = particles
        self.radial = radial
        self.window = Window(grid)
        self.acoustic_time = math.inf
        self.mean_speed = 0.0
        self.relaxation = Relaxation(scheme, radial)
        self.forces = Forces(case, grid, particles)
        self.walls = Walls(case, grid, self.window, particles)
        self.faces = Faces(grid)
        self.sources = Sources(case, grid, self.window, particles)
        spacing = min(grid.cell_size / min(one.particles_along_axes(dim)) for one in case.filled)
        self.stage = Stage(scheme, grid, self.walls, particles, radial, case.gravity_vector, spacing)
        support = scheme.shape.support
        self._scatter = scatter(dim, support)
        self._gather = gather(dim, support, scheme.velocity.affine)
        self._gradient_due = False
        self._begun = 0
        self._auditing = self._rehearsing = True
        self._all_fluid = all(group.law.uses_equation_of_state for group in particles.groups)
        self._account = audit.Account()
        self._for_order = operations_for(scheme.order, self)
        self._for_velocity = operations_for(scheme.velocity, self)
        self._for_volumetric = operations_for(scheme.volumetric, self)
        self.allocate()

    def allocate(self) -> None:
        """Allocate tables and scratch arrays for all particles; call again when particles were added."""
        n, dim, support = len(self.particles), self.grid.dim, self.scheme.shape.support
        self.sorting = Sorting(self.grid, self.particles, self.window)
        self.walls.follow(self.sorting)
        self.base = np.zeros((n, dim), dtype=np.int32)
        # One block of memory: a sort and a redistribution use that of the tables for their temporary arrays.
        size = n * dim * support
        self._tables = np.zeros(max(2 * size, n * WIDEST))
        self.weight, self.gradient = self._tables[: 2 * size].reshape(2, n, dim, support)
        self.hoop = np.zeros((n, support if self.radial else 0))
        self.stage.lend(self.base, self._tables)
        self._radial_tables = self.base[:, 0], self.weight[:, 0], self.gradient[:, 0]
        self._axial_tables = self.base[:, 1:], self.weight[:, 1:], self.gradient[:, 1:]
        self.averager = Averager(
            self.particles, self.window, self.sorting, self.walls, self.base, self.weight
        )
        self.touch = Touch(self.grid, self.particles, self.radial, self.scheme.shape)
        self._rate = np.zeros(n)
        self._stepped = False
        self._no_rows = np.zeros((0, dim))

    def renew(self, time: float) -> None:
        """Allocate, sort, and lay the walls at a time, s, after particles were added or removed.

        Afterwards the state is complete: a checkpoint contains the memory of wall contacts. ``begin`` reports
        a particle that has left the grid.
        """
        self.allocate()
        if self._sort() is None:
            self.walls.move_to(time)

    # --- State

    @property
    def components(self) -> dict[str, Stateful]:
        """The components with a state, in the order in which they are restored."""
        return {
            "window": self.window,
            "sorting": self.sorting,
            "relaxation": self.relaxation,
            "stage": self.stage,
            "forces": self.forces,
            "walls": self.walls,
            "faces": self.faces,
            "sources": self.sources,
        }

    def state(self) -> State:
        """Its numbers, its components, and the last weights, which the mass guard reads."""
        return plain_state(self, but=FILLED_ANEW) | {"weight/": self.weight} | state_of(self.components)

    def restore(self, state: State) -> None:
        """Restore a state; the particles must be restored before."""
        self.allocate()
        self.weight[...] = state["weight/"]
        restore(self.components, state)
        restore_plain(self, state)

    # --- The frame of a step

    @property
    def time(self) -> float:
        """Time at the start of the present step, s."""
        return self.particles.time

    def begin(self, time: float = 0.0) -> int | None:
        """Sort if needed, move the walls to a time, s, evaluate the shape functions.

        Returns:
            Index of a particle that left the grid; None if there is none.
        """
        self.particles.time = time
        lost = self._sort()
        if lost is None and self.stage.redistribute_if_due(self.window, self.sorting):
            lost = self._sort()
        if lost is None:
            self._rehearsing = self._begun % audit.INTERVAL == 0
            self._auditing = len(self.particles) < audit.FEW or self._begun % audit.LOOKS == 0
            self._begun += 1
            self.walls.move_to(time)
            self._evaluate_shapes()
            self.touch.mark(self.window, self.sorting, self.base, self.weight, begins=self._begun == 1)
            self.walls.mark(self.base, self.weight)
        return lost

    def _sort(self) -> int | None:
        return self.sorting.refresh(self.base, self._tables)

    def _evaluate_shapes(self) -> None:
        p, shape, dx = self.particles, self.scheme.shape, self.grid.cell_size
        if self._rehearsing:
            audit.rehearse_shape(shape, p.position, p.half_size, dx, self.radial)
        if self.radial:
            radius, radial_half_size = p.position[:, 0], p.half_size[:, 0]
            shape.fill_radial(radius, radial_half_size, dx, *self._radial_tables, self.hoop)
            shape.fill(p.position[:, 1:], p.half_size[:, 1:], dx, *self._axial_tables)
        else:
            shape.fill(p.position, p.half_size, dx, self.base, self.weight, self.gradient)
        audit.require_bounds(shape, p.position, dx, self.base, p.number)
        if self._begun % audit.LOOKS == 1:
            self.require_tables()

    def require_tables(self) -> None:
        """Raise PluginFault if the weights of the present step cannot be right."""
        shape, numbers = self.scheme.shape, self.particles.number
        audit.require_weights(shape, self.weight, self.gradient, self.grid.cell_size, numbers)
        audit.require_finite(shape, "a 'hoop'", self.hoop, numbers, ())

    def start(self) -> None:
        """Before the first step: compute the affine part of an initial velocity from the grid."""
        if self.scheme.velocity.affine and self.particles.velocity.any():
            self.map_to_grid(forces=False)
            self._take(affine=True)

    def step(self, dt: float) -> None:
        """One step of the chosen order."""
        self._account.begin()
        self.forces.act(self.time, dt)
        self.sources.begin(self.time, dt, self.sorting)
        try:
            self.scheme.order.step(self._for_order, dt)
        except PluginFault:  # wrong weights may be the real cause of the fault
            self.require_tables()
            raise
        self._account.require_whole(self.scheme.order, dt)
        self._stepped = True

    # --- Particles to nodes

    def map_to_grid(self, *, forces: bool = True) -> None:
        active = self.sorting.active
        nodes.clear(self.window.nodes, active.rows, active.tasks)
        self._map(momentum=True, forces=forces)
        self._fold(0, 1 + (2 if forces else 1) * self.grid.dim)
        self.walls.fold(True, forces)
        nodes.momentum_to_velocity(self.window.nodes, *self._faces(), self.faces.mapped)
        self._walls_act()
        self._account.mapped(forces)

    def map_forces(self) -> None:
        dim = self.grid.dim
        self._map(momentum=False, forces=True)
        self._fold(1 + dim, 1 + 2 * dim)
        self.walls.fold(False, True)
        self._account.forced()

    def remap_velocity(self) -> None:
        self.map_to_grid(forces=False)

    def _map(self, momentum: bool, forces: bool) -> None:
        p, w = self.particles, self.window
        volume = p.volume
        if forces:
            volumes.assign(p.mapped_pressure, self._treated(p.pressure))
            if self.stage.acts:
                volume = p.volume * p.quadrature
        self._scatter(
            w.nodes, w.strides, w.lower, self.sorting.tasks, self.base, self.weight, self.gradient, self.hoop,
            p.mass, p.velocity, p.affine, volume, p.stress, p.mapped_pressure,
            self.forces.acceleration, self.cell_size, momentum, forces,
        )  # fmt: skip
        self.sources.map(momentum, forces, self.forces.acceleration)

    def _fold(self, first: int, last: int) -> None:
        active = self.sorting.active
        planes = active.faces, active.mirrors, active.plane_first
        nodes.fold_held(self.window.nodes, *planes, first, last, active.held)

    def _faces(self) -> tuple[Any, ...]:
        """Arguments of the kernels that apply the faces and sum up their impulses."""
        active, grid = self.sorting.active, self.grid
        return (
            *active.arguments, grid.friction, active.places, grid.cell_size, active.held, self.walls.touched
        )  # fmt: skip

    def _walls_act(self, dt: float | None = None) -> None:
        """Apply the walls to the velocities after mapping, or after the momentum equation (step ``dt``)."""
        if self.walls.touched:
            self.walls.constrain(self.faces.given(dt is not None), dt, self._rehearsing)
            self.faces.fill(self.window, self.sorting.active, dt)
        self.sources.carry(dt)

    # --- Nodes

    @property
    def mapped_mass(self) -> float | None:
        """Mass mapped to the nodes in the last step, kg; None if there was no step since they were made."""
        if not self._stepped:
            return None
        return float(self.window.nodes[:, 0].sum()) - self.sources.mapped_mass

    def solve_momentum(self, dt: float) -> None:
        self._account.solved(dt)
        given = self.faces.sums, self.faces.mapped
        nodes.solve_momentum(self.window.nodes, *self._faces(), *given, dt)
        self._walls_act(dt)
        if self.forces:
            self.forces.count(self._doubled_mean_velocity(dt), dt)

    def _doubled_mean_velocity(self, dt: float) -> np.ndarray:
        """2 Σ N (v - Δv/2), m/s, ``(n, dim)``: what a particle at rest takes with flip = -1."""
        p, w = self.particles, self.window
        found = np.zeros_like(p.velocity)
        self._gather(
            w.nodes, w.strides, w.lower, self.base, self.weight, self.gradient, self.hoop, self.cell_size,
            0.0, -1.0, np.zeros_like(p.position), found, p.velocity_gradient, self._rate, p.affine, True,
            False, False,
        )  # fmt: skip
        return found

    # --- Nodes to particles

    def map_to_particles(self, dt: float, *, velocity_gradient: bool = False) -> None:
        self._account.moves(dt)
        self._gradient_due = velocity_gradient
        before = self._places() if self._rehearsing and self._moves() else None
        self.scheme.velocity.map_to_particles(self._for_velocity, dt)
        by_itself = before is None or not np.array_equal(before, self._places())
        self._account.require_moved(self.scheme.velocity, dt, by_itself)
        if self._gradient_due:  # the velocity update computes its own
            self.update_velocity_gradient()

    def _moves(self) -> bool:
        """Whether a step moves any particle at all."""
        return bool(self.forces.acceleration.any() or self.particles.velocity.any())

    def _places(self) -> np.ndarray:
        """Positions of some of the particles, to detect whether they are moved."""
        return self.particles.position[: audit.SAMPLE].copy()

    def move_particles(self, dt: float, *, flip: float, affine: bool = False) -> None:
        self._account.advances(dt, graded=self._gradient_due)
        if not audit.is_finite(flip):
            raise PluginFault(self.scheme.velocity, f"asked for a flip of {flip}; it must be a finite number")
        self.walls.taken_up(flip)
        self.faces.taken_up(1 - flip)
        self.sources.taken_up(flip)
        self._take(dt=dt, flip=flip, move=True, strain=self._gradient_due, affine=affine)
        self._gradient_due = False

    def update_velocity_gradient(self) -> None:
        self._take(strain=True)
        self._account.graded()
        self._gradient_due = False

    def _take(
        self,
        dt: float = 0.0,
        flip: float = 0.0,
        move: bool = False,
        strain: bool = False,
        affine: bool = False,
    ) -> None:
        p, w = self.particles, self.window
        self._gather(
            w.nodes, w.strides, w.lower, self.base, self.weight, self.gradient, self.hoop, self.cell_size,
            dt, flip, p.position, p.velocity, p.velocity_gradient, self._rate, p.affine, move, strain, affine,
        )  # fmt: skip

    # --- Particles

    def update_stress(self, dt: float) -> None:
        p = self.particles
        self._account.stressed(dt)
        p.age += dt
        self._update_volumes(dt)
        self._follow_domains(dt)
        for group in p.present_groups:
            self._update_law(group, dt)

    def _update_law(self, group: Group, dt: float) -> None:
        p, kinematics, stress = (
            self.particles,
            self.particles.kinematics(group),
            self.particles.stress[group.part],
        )
        if self._rehearsing:
            audit.rehearse_law(group.law, kinematics, group.state, stress, dt, p.number[group.part])
        group.law.update_stress(kinematics, group.state, dt, stress)
        if self._auditing:
            audit.require_stress(group.law, kinematics, dt, stress, p.number[group.part])

    def _update_volumes(self, dt: float) -> None:
        p = self.particles
        self.relax_volume(dt)
        self.stage.stretch(self._treated(self._rate), dt)
        if p.deformation_gradient is not None:
            tensors.deform(p.velocity_gradient, dt, p.deformation_gradient)
        for group in p.present_groups:
            part = group.part
            if group.law.uses_equation_of_state:
                volumes.assign(p.pressure[part], self._pressure(group, p.volume_ratio[part]))
            elif group.law.needs_deformation_gradient:  # its volume must agree with the F given to the law
                assert p.deformation_gradient is not None
                tensors.determinant(p.deformation_gradient[part], p.volume_ratio[part])
                np.multiply(p.volume_ratio[part], p.initial_volume[part], out=p.volume[part])

    def _pressure(self, group: Group, volume_ratio: np.ndarray) -> np.ndarray:
        author, speed = group.equation_of_state, group.sound_speed
        if self._rehearsing and speed is not None:
            numbers = self.particles.number[group.part]
            audit.rehearse_equation_of_state(author, volume_ratio, group.density, speed, numbers)
        pressure = group.pressure(volume_ratio)
        audit.require_array(author, "pressure", pressure, volume_ratio.shape)
        if self._auditing:
            numbers = self.particles.number[group.part]
            audit.require_finite(author, "a pressure", pressure, numbers, [volume_ratio])
        return pressure

    def _follow_domains(self, dt: float) -> None:
        p = self.particles
        if not self.scheme.redistribution.equal_boxes:
            self._follow_deformation(slice(0, len(p)), dt)
        elif not self._all_fluid:
            for group in p.present_groups:
                if not group.law.uses_equation_of_state:
                    self._follow_deformation(group.part, dt)
        self.stage.follow(dt)

    def _follow_deformation(self, part: slice, dt: float) -> None:
        p, rule = self.particles, self.scheme.shape.particle_domain
        least = self._no_rows if p.least_half_size is None else p.least_half_size[part]
        domains.follow_strain(p.velocity_gradient[part], dt, p.box[part], least, p.half_size[part])
        if rule == "stretch":
            assert p.deformation_gradient is not None
            assert p.initial_half_size is not None
            F, initial = p.deformation_gradient[part], p.initial_half_size[part]
            domains.follow_stretch(F, initial, p.half_size[part])
        elif rule == "volume":
            assert p.initial_half_size is not None
            domains.follow_volume(p.volume_ratio[part], p.initial_half_size[part], p.half_size[part])

    # --- Volumes

    def _treated(self, field: np.ndarray) -> np.ndarray:
        """A field after the volumetric treatment; laws that compute their own pressure keep their values."""
        author = self.scheme.volumetric
        if self._rehearsing:
            rehearsed = audit.Rehearsed(field)
            treated = rehearsed.result(author, author.average(self._for_volumetric, rehearsed.field))
        else:
            treated = author.average(self._for_volumetric, field)
        if treated is not field:
            audit.require_array(author, "average", treated, field.shape)
            if self._auditing:
                audit.require_finite(author, "an average", treated, self.particles.number, [field])
            if not self._all_fluid:
                treated = treated.copy()  # the treatment may keep a reference to it
                for group in self.particles.groups:
                    if not group.law.uses_equation_of_state:
                        treated[group.part] = field[group.part]
        return treated

    def relax_volume(self, dt: float) -> None:
        if self.scheme.redistribution.equal_boxes:
            return
        author = self.scheme.volumetric
        asked = author.relaxation_rate(self._for_volumetric)
        rate = audit.require_number(author, "relaxation_rate", asked)
        self.relaxation.relax(self.averager, rate, dt)

    # --- Fields in general

    def average(self, values: np.ndarray, weighting: Weighting = "volume") -> np.ndarray:
        _require_field(values, self._rate.shape)
        self.averager.at_nodes(values, self._weights(weighting))
        return self.averager.at_particles()

    def particles_to_nodes(self, values: np.ndarray, weighting: Weighting = "volume") -> np.ndarray:
        _require_field(values, self._rate.shape)
        self.averager.at_nodes(values, self._weights(weighting))
        return self.window.average[:, 0].copy()

    def nodes_to_particles(self, nodal: np.ndarray) -> np.ndarray:
        _require_field(nodal, self.window.average.shape[:1])
        self.window.average[:, 0] = nodal
        return self.averager.at_particles()

    def _weights(self, weighting: Weighting) -> np.ndarray:
        """Weight of every particle in an average; volumes only for particles with an equation of state."""
        p = self.particles
        if weighting not in ("mass", "volume"):
            asked = f"asked for an average by {weighting!r}; it must be by 'mass' or 'volume'"
            raise PluginFault(None, asked)
        if weighting == "mass" or self._all_fluid:
            return p.mass if weighting == "mass" else p.volume
        weights = p.volume.copy()
        for group in p.groups:
            if not group.law.uses_equation_of_state:
                weights[group.part] = 0.0
        return weights


def _require_field(values: Any, shape: tuple[int, ...]) -> None:
    """Raise PluginFault, of the plug-in that called, unless values are ``(count,)`` real numbers."""
    if not isinstance(values, np.ndarray) or values.shape != shape or values.dtype.kind not in "fiu":
        what = (
            f"{values.shape} of {values.dtype}" if isinstance(values, np.ndarray) else type(values).__name__
        )
        raise PluginFault(
            None, f"asked for an average of {what}; it must be an array of {shape[0]} real numbers"
        )
