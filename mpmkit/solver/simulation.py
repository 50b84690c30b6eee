"""A scene in motion: its state, its clock, and the guards that stop it when it diverges."""

from __future__ import annotations

import math

import numpy as np

from ..case.model import Case
from ..kernels.sums import kinetics
from .grid import Grid
from .guards import Guards, stop
from .measures import Measures
from .operations import SceneOperations
from .particles import Particles
from .scene import make_particles
from .sorting import Scattered
from .sound import follow_flow, mach_number
from .splitting import OutOfMemory, split
from .time_step import Limits, choose_step, limits, warnings

CONTROL_INTERVAL = 20
"""Steps between two looks at the limits of the time step; in as many, no flow changes its speed much."""
IMPACT_INTERVAL = 5
"""The same where there is a solid, which an impact stiffens within a dozen steps."""


class Simulation:
    """Particles, grid and schemes of a case, advanced step by step.

    >>> simulation = Simulation(case)
    >>> while simulation.time < case.until:
    ...     simulation.advance()
    """

    def __init__(self, case: Case, particles: Particles | None = None, fraction: float | None = None) -> None:
        """
        Args:
            case: a validated case.
            particles: a state to go on from; the case's bodies in their places unless told.
            fraction: part of the critical step, whatever the schemes say that they bear: for trying them.
        """
        self.case = case
        self.fraction = fraction
        self.grid = Grid.of(case)
        self.particles = make_particles(case) if particles is None else particles
        self.operations = SceneOperations(
            case.scheme, self.grid, self.particles, case.gravity_vector, case.space_.radial
        )
        self.measures = Measures.of(case, self.grid, self.particles)
        self.time = 0.0
        self.steps = 0
        self.limits: Limits
        self.time_step: float
        self.limited_by: str
        self.mach_number: float
        """Largest speed over the slowest sound, a few steps ago at most."""
        self.particle_steps = 0
        self._first_sound_speeds = [group.sound_speed for group in self.particles.groups]
        fluid = all(group.law.uses_equation_of_state for group in self.particles.groups)
        self._interval = CONTROL_INTERVAL if fluid else IMPACT_INTERVAL
        self.guards = Guards(self)
        self.choose_time_step()

    def choose_time_step(self) -> None:
        """Recompute the limits, and with them the step."""
        p = self.particles
        mass, doubled, square = kinetics(p.mass, p.velocity)
        speed = math.sqrt(square)
        self.mach_number = mach_number(p, speed)
        self.limits = limits(p, self.grid.cell_size, speed, self.case.scale.rate)
        self.time_step, self.limited_by = choose_step(self.case.scheme, self.limits, self.fraction)
        self.operations.acoustic_time = self.limits.acoustic
        self.operations.mean_speed = math.sqrt(doubled / mass)
        self.guards.check_step()

    def remarks(self) -> list[str]:
        """What the laws have to say of themselves, and what will change on the way."""
        said = [sentence for group in self.particles.groups for sentence in group.remarks]
        for group in self.particles.groups:
            if group.mach is not None:
                said.append(
                    f"the sound speed follows the flow, at first {group.sound_speed:.4g} m/s; "
                    "an elastic modulus stays as it is"
                )
        return list(dict.fromkeys(said))

    def warnings(self) -> list[str]:
        """What the user should know of the materials, and of the step that was chosen."""
        scale, until = self.case.scale, self.case.until
        of_materials = [
            sentence
            for group in self.particles.groups
            for sentence in group.law.warnings(group.density, group.sound_speed, scale, until)
        ]
        return [*dict.fromkeys(of_materials), *warnings(self.case.scheme, self.limits, self.time_step)]

    def advance(self, at_most: float = np.inf) -> float:
        """One step, no longer than ``at_most`` seconds; returns its length.

        Raises:
            GuardStop: the run is beyond saving, see ``guards``.
        """
        self.guards.begin()
        if self.steps % self._interval == 0 and self.steps > 0:
            self.check()
            if self.case.scheme.splitting and self._split():
                self.guards.accept_changes()
            self._follow_flow()
            self.choose_time_step()
        try:
            lost = self.operations.begin()
        except Scattered as error:
            stop(self, error.particle, scattered=True)
        if lost is not None:
            stop(self, lost)
        if self.steps == 0:
            self.operations.start()
        dt = min(self.time_step, at_most)
        self.operations.step(dt)
        self.time += dt
        self.steps += 1
        self.particle_steps += len(self.particles)
        return dt

    def _follow_flow(self) -> None:
        """Recompute the sound speeds that are to follow the flow."""
        gravity, elapsed = self.case.gravity_vector, self._interval * self.time_step
        follow_flow(self.particles, self.grid, gravity, self._first_sound_speeds, elapsed)

    def _split(self) -> bool:
        """Split particles whose boxes are too long; whether there were any."""
        try:
            found = split(self.particles, self.grid, self.case.space_.radial)
        except OutOfMemory as error:
            stop(self, error.particle, drawn_out=True)
        if found:
            self.operations.allocate()
        return found

    @property
    def mapped_mass(self) -> float | None:
        """Mass that the nodes got in the last step, kg; None where there was no step yet."""
        return self.operations.mapped_mass

    def sum_of_weights(self) -> np.ndarray:
        """Σ N of every particle, ``(n,)``, of the last step: 1 but for rounding."""
        return np.prod(self.operations.weight.sum(axis=-1), axis=1)

    def check(self) -> None:
        """Raise GuardStop if the run is beyond saving, see ``guards``."""
        self.guards.check()
