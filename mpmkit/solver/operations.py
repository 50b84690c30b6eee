"""The operations of a step on the particles and nodes of one scene: the contract ``Operations`` made real."""

from __future__ import annotations

import math

import numpy as np

from ..case.model import Scheme
from ..contracts.operations import Measure
from ..errors import PluginFault
from ..kernels import domains, nodes, tensors, volumes
from ..kernels.gather import gather
from ..kernels.scatter import scatter
from ..registry import audit
from .averager import Averager
from .grid import Grid, Window
from .particles import Group, Particles
from .redistribution import Stage
from .relaxation import Relaxation
from .sorting import Sorting

WIDEST = 9
"""Doubles of the widest array of the particles, a tensor."""


class SceneOperations:
    """What one step is made of. Shape functions are evaluated in ``begin`` and hold for the whole step."""

    def __init__(
        self, scheme: Scheme, grid: Grid, particles: Particles, gravity: np.ndarray, radial: bool
    ) -> None:
        dim = grid.dim
        self.scheme = scheme
        self.grid = grid
        self.cell_size = grid.cell_size
        self.particles = particles
        self.gravity = gravity
        self.radial = radial
        self.window = Window(grid)
        self.acoustic_time = math.inf
        self.mean_speed = 0.0
        self.relaxation = Relaxation(scheme, radial)
        self.stage = Stage(scheme, grid, particles, radial)
        support = scheme.shape.support
        self._scatter, self._gather = scatter(dim, support), gather(dim, support)
        self._gradient_due = False
        self._begun = 0
        self._auditing = True
        self.allocate()

    def allocate(self) -> None:
        """Tables and scratch for as many particles as there are; to be called again when there are more."""
        n, dim, support = len(self.particles), self.grid.dim, self.scheme.shape.support
        self.sorting = Sorting(self.grid, self.particles, self.window)
        self.base = np.zeros((n, dim), dtype=np.int32)
        # One block of memory, so that what a sort needs for a moment can lie where the tables will be again.
        size = n * dim * support
        self._tables = np.zeros(max(2 * size, n * WIDEST))
        self.weight, self.gradient = self._tables[: 2 * size].reshape(2, n, dim, support)
        self.hoop = np.zeros((n, support if self.radial else 0))
        self.averager = Averager(self.particles, self.window, self.sorting, self.base, self.weight)
        self._rate = np.zeros(n)
        self._stepped = False
        self._no_rows = np.zeros((0, dim))

    # --- The frame of a step

    def begin(self) -> int | None:
        """Sort if needed, evaluate the shape functions. Returns a particle that left the grid, if any did."""
        lost = self._sort()
        if lost is None and self.stage.redistribute_if_due(self.window, self.sorting):
            lost = self._sort()
        if lost is None:
            self._rehearsing = self._begun % audit.INTERVAL == 0
            self._auditing = len(self.particles) < audit.FEW or self._begun % audit.LOOKS == 0
            self._begun += 1
            self._evaluate_shapes()
        return lost

    def _sort(self) -> int | None:
        return self.sorting.refresh(self.base, self._tables)

    def _evaluate_shapes(self) -> None:
        p, shape, dx = self.particles, self.scheme.shape, self.grid.cell_size
        if self._rehearsing:
            audit.rehearse_shape(shape, p.position, p.half_size, dx, self.radial)
        tables = p.position, p.half_size, self.base, self.weight, self.gradient
        if self.radial:
            radius, half_size, base, weight, gradient = (table[:, 0] for table in tables)
            shape.fill_radial(radius, half_size, dx, base, weight, gradient, self.hoop)
            tables = tuple(table[:, 1:] for table in tables)  # type: ignore[assignment]
        position, half_size, base, weight, gradient = tables
        shape.fill(position, half_size, dx, base, weight, gradient)

    def start(self) -> None:
        """Before the first step: read the affine part of an initial velocity off the grid."""
        if self.scheme.velocity.affine and self.particles.velocity.any():
            self.map_to_grid(forces=False)
            self._take(affine=True)

    def step(self, dt: float) -> None:
        """One step of the chosen order."""
        self.scheme.order.step(self, dt)
        self._stepped = True

    # --- Particles to nodes

    def map_to_grid(self, *, forces: bool = True) -> None:
        active = self.sorting.active
        nodes.clear(self.window.nodes, active.rows, active.tasks)
        self._map(momentum=True, forces=forces)
        self._fold(0, 1 + (2 if forces else 1) * self.grid.dim)
        nodes.momentum_to_velocity(self.window.nodes, *active.arguments, self.grid.friction)

    def map_forces(self) -> None:
        dim = self.grid.dim
        self._map(momentum=False, forces=True)
        self._fold(1 + dim, 1 + 2 * dim)

    def remap_velocity(self) -> None:
        self.map_to_grid(forces=False)

    def _map(self, momentum: bool, forces: bool) -> None:
        p, w = self.particles, self.window
        volume = p.volume
        if forces:
            volumes.assign(p.mapped_pressure, self._treated(p.pressure))
            if self.scheme.redistribution.equal_boxes:
                volume = p.volume * p.quadrature
        self._scatter(
            w.nodes, w.strides, w.lower, self.sorting.tasks, self.base, self.weight, self.gradient, self.hoop,
            p.mass, p.velocity, p.affine, volume, p.stress, p.mapped_pressure, self.gravity,
            self.cell_size, momentum, forces,
        )  # fmt: skip

    def _fold(self, first: int, last: int) -> None:
        active = self.sorting.active
        nodes.fold(self.window.nodes, active.faces, active.mirrors, active.face_first, first, last, True)

    # --- Nodes

    @property
    def mapped_mass(self) -> float | None:
        """Mass that the nodes got in the last step, kg; None where there was none since they were made."""
        return float(self.window.nodes[:, 0].sum()) if self._stepped else None

    def solve_momentum(self, dt: float) -> None:
        nodes.solve_momentum(self.window.nodes, *self.sorting.active.arguments, self.grid.friction, dt)

    # --- Nodes to particles

    def map_to_particles(self, dt: float, *, velocity_gradient: bool = False) -> None:
        self._gradient_due = velocity_gradient
        self.scheme.velocity.map_to_particles(self, dt)
        if self._gradient_due:  # the velocity update has ways of its own
            self.update_velocity_gradient()

    def advance(self, dt: float, *, flip: float, affine: bool = False) -> None:
        if not math.isfinite(flip):
            raise PluginFault(self.scheme.velocity, f"asked for a flip of {flip}; it must be a finite number")
        self._take(dt=dt, flip=flip, move=True, strain=self._gradient_due, affine=affine)
        self._gradient_due = False

    def update_velocity_gradient(self) -> None:
        self._take(strain=True)
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
        self._update_volumes(dt)
        self._follow_domains(dt)
        for group in p.groups:
            self._update_law(group, dt)

    def _update_law(self, group: Group, dt: float) -> None:
        p, motion, stress = self.particles, self.particles.motion(group), self.particles.stress[group.part]
        if self._rehearsing:
            audit.rehearse_law(group.law, motion, group.state, stress, dt, p.number[group.part])
        group.law.update_stress(motion, group.state, dt, stress)
        if self._auditing:
            audit.require_stress(group.law, motion, dt, stress, p.number[group.part])

    def _update_volumes(self, dt: float) -> None:
        p = self.particles
        self.relax_volume(dt)
        volumes.stretch(self._treated(self._rate), dt, p.initial_volume, p.volume_ratio, p.volume)
        if p.deformation_gradient is not None:
            tensors.deform(p.velocity_gradient, dt, p.deformation_gradient)
        for group in p.groups:
            part = group.part
            if group.law.uses_equation_of_state:
                volumes.assign(p.pressure[part], self._pressure(group, p.volume_ratio[part]))
            elif group.law.needs_deformation_gradient:  # its volume must be that of the F that it sees
                assert p.deformation_gradient is not None
                tensors.determinant(p.deformation_gradient[part], p.volume_ratio[part])
                np.multiply(p.volume_ratio[part], p.initial_volume[part], out=p.volume[part])

    def _pressure(self, group: Group, volume_ratio: np.ndarray) -> np.ndarray:
        pressure, author = group.pressure(volume_ratio), group.equation_of_state
        audit.require_shape(author, "pressure", pressure, volume_ratio.shape)
        if self._auditing:
            numbers = self.particles.number[group.part]
            audit.require_finite(author, "a pressure", pressure, numbers, [volume_ratio])
        return pressure

    def _follow_domains(self, dt: float) -> None:
        p, rule = self.particles, self.scheme.shape.particle_domain
        if self.scheme.redistribution.equal_boxes:
            self.stage.follow(dt)
            return
        least = self._no_rows if p.least_half_size is None else p.least_half_size
        domains.follow_strain(p.velocity_gradient, dt, p.box, least, p.half_size)
        if rule == "stretch":
            domains.follow_stretch(p.deformation_gradient, p.initial_half_size, p.half_size)
        elif rule == "volume":
            domains.follow_volume(p.volume_ratio, p.initial_half_size, p.half_size)

    # --- Volumes

    def _treated(self, field: np.ndarray) -> np.ndarray:
        """What the volumetric treatment makes of a field; a law with a pressure of its own keeps its own."""
        treated, author = self.scheme.volumetric.average(self, field), self.scheme.volumetric
        if treated is not field:
            audit.require_shape(author, "average", treated, field.shape)
            if self._auditing:
                audit.require_finite(author, "an average", treated, self.particles.number, [field])
            for group in self.particles.groups:
                if not group.law.uses_equation_of_state:
                    treated[group.part] = field[group.part]
        return treated

    def relax_volume(self, dt: float) -> None:
        if self.scheme.redistribution.equal_boxes:
            return
        self.relaxation.relax(self.averager, self.scheme.volumetric.relaxation_rate(self), dt)

    # --- Fields in general

    def average(self, values: np.ndarray, measure: Measure = "volume") -> np.ndarray:
        self.averager.at_nodes(values, self._weights(measure))
        return self.averager.at_particles()

    def particles_to_nodes(self, values: np.ndarray, measure: Measure = "volume") -> np.ndarray:
        self.averager.at_nodes(values, self._weights(measure))
        return self.window.average[:, 0].copy()

    def nodes_to_particles(self, nodal: np.ndarray) -> np.ndarray:
        self.window.average[:, 0] = nodal
        return self.averager.at_particles()

    def _weights(self, name: Measure) -> np.ndarray:
        """Weight of every particle in an average; volumes only of what has an equation of state."""
        p = self.particles
        measure = p.mass if name == "mass" else p.volume
        if name != "mass" and not all(group.law.uses_equation_of_state for group in p.groups):
            measure = measure.copy()
            for group in p.groups:
                if not group.law.uses_equation_of_state:
                    measure[group.part] = 0.0
        return measure
