"""A scene with its state and time, and the guards that stop it when it diverges."""

from __future__ import annotations

import math

import numpy as np

from ..case.model import Case
from ..case.plugins import plugins_of
from ..kernels.environment import require_threads
from ..kernels.sums import kinetics
from ..registry.audit.forces import settles, shortest_period
from ..registry.blame import blaming_plugins
from .beginning import begin_with_fields
from .diagnosed import diagnosed
from .draining import Drains
from .grid import Grid
from .guards import Guards, stop
from .ledger import FORCES, IN, REDISTRIBUTION, WALLS, Ledger, present
from .measures import Measures
from .operations import SceneOperations
from .particles import Particles
from .refinement import Refiner
from .rest import put_under_weight, swinging
from .scene import make_particles
from .sorting import Scattered
from .sound import follow_flow, mach_number
from .splitting import OutOfMemory
from .stateful import State, Stateful, plain_state, restore, restore_plain, state_of
from .time_step import Limits, choose_step, limits, warnings

CONTROL_INTERVAL = 20
"""Steps between two checks of the time step; in so few steps, no flow changes its speed much."""
IMPACT_INTERVAL = 5
"""The same for scenes with a solid, because an impact can stiffen it within a dozen steps."""


class Simulation:
    """Particles, grid and schemes of a case, advanced step by step.

    >>> simulation = Simulation(case)
    >>> while simulation.time < case.end:
    ...     simulation.advance()
    """

    def __init__(self, case: Case, particles: Particles | None = None, fraction: float | None = None) -> None:
        """
        Args:
            case: a validated case.
            particles: the initial particles; default: the bodies of the case.
            fraction: part of the critical step; may exceed the stable part of the schemes, for tests.

        Raises:
            MpmkitError: this process was forked from one that had used the threads.
        """
        require_threads()
        self.case = case
        self.fraction = fraction
        self.time = 0.0
        self.steps = 0
        self.blaming = blaming_plugins(plugins_of(case), lambda: (self.steps, self.time))
        """A block in which faults of plug-ins raise PluginStop with the plug-in, the step and the time."""
        with self.blaming:
            self._set_up(particles)

    def _set_up(self, particles: Particles | None) -> None:
        case = self.case
        self.grid = Grid.of(case)
        self.particles = make_particles(case) if particles is None else particles
        pressed = particles is None and begin_with_fields(case, self.particles, self.grid.lower)
        begins = particles is None and not pressed
        self.starts_under_weight = begins and put_under_weight(case, self.grid, self.particles)
        begins = begins and not self.starts_under_weight
        self.swinging = swinging(case, self.grid, self.particles) if begins else None
        """The warning about a pressure that oscillates about the hydrostatic pressure."""
        self.operations = SceneOperations(case, self.grid, self.particles)
        self.refiner = Refiner(case, self.grid, self.particles)
        self.measures = Measures.of(case, self.grid, self.particles)
        self.limits: Limits
        self.time_step: float
        self.limited_by: str
        self.mach_number: float
        """Largest speed over the lowest sound speed, at most a few steps old."""
        self.particle_steps = 0
        self._prepared = 0
        """The number of steps done at the last check of ``prepare``."""
        self._first_sound_speeds = [group.sound_speed for group in self.particles.groups]
        fluid = all(group.law.uses_equation_of_state for group in self.particles.groups)
        self._interval = CONTROL_INTERVAL if fluid else IMPACT_INTERVAL
        self.ledger = Ledger(self.grid, case.gravity_vector, len(case.sinks))
        self.drains = Drains(case, self.grid, self.particles, self.ledger)
        self.guards = Guards(self)
        self.choose_time_step()

    @property
    def components(self) -> dict[str, Stateful]:
        """The components with a state, in the order in which they are restored."""
        return {
            "particles": self.particles,
            "operations": self.operations,
            "ledger": self.ledger,
            "drains": self.drains,
            "guards": self.guards,
        }

    def state(self) -> State:
        """The complete state, without the case: a run continues from it bit by bit the same."""
        limits_ = np.array(list(self.limits.as_dict().values()))
        return plain_state(self) | {"limits/": limits_} | state_of(self.components)

    def restore(self, state: State) -> None:
        """Restore a state of the same case.

        Raises:
            KeyError: an entry of the state is missing.
        """
        restore_plain(self, state)
        self.limits = Limits(*map(float, state["limits/"]))
        restore(self.components, state)

    def choose_time_step(self) -> None:
        """Recompute the limits, and with them the step."""
        with self.blaming:
            self._choose_time_step()

    def _choose_time_step(self) -> None:
        p = self.particles
        mass, doubled, square = kinetics(p.mass, p.velocity)
        ahead = self.time + self._interval * getattr(self, "time_step", 0.0)
        driven = (self.operations.walls, self.operations.sources)
        speed = max(math.sqrt(square), *(one.fastest(self.time, ahead) for one in driven))
        self.mach_number = mach_number(p, speed)
        mass = mass or 1.0  # a scene may begin empty
        waves = [(group, p.wave_speed(group)) for group in p.groups]
        periods = [shortest_period(force) for force in self.case.varying_forces.values()]
        self.limits = limits(waves, self.grid.cell_size, speed, self.case.scale.rate, periods)
        self.time_step, self.limited_by = choose_step(self.case.scheme, self.limits, self.fraction)
        self.operations.acoustic_time = self.limits.acoustic
        self.operations.mean_speed = math.sqrt(doubled / mass)
        self.guards.check_step()

    def remarks(self) -> list[str]:
        """Sentences of the laws, and about quantities that will change during the run."""
        with self.blaming:
            said = [sentence for group in self.particles.groups for sentence in group.remarks]
        if self.starts_under_weight:
            said.append("the fluid rests between walls: it starts with the pressure of its weight")
        elif self.swinging is not None:
            said.append(self.swinging)
        for group in self.particles.groups:
            if group.mach is not None:
                said.append(
                    f"the sound speed follows the flow, at first {group.sound_speed:.4g} m/s; "
                    "an elastic modulus does not change"
                )
        return list(dict.fromkeys(said))

    def warnings(self) -> list[str]:
        """Sentences on problems of the materials and of the chosen step."""
        with self.blaming:
            of_materials = [
                sentence
                for group in self.particles.groups
                for sentence in group.warnings(self.case.scale, self.case.end)
            ]
            return [*dict.fromkeys(of_materials), *warnings(self.case.scheme, self.limits, self.time_step)]

    def prepare(self) -> None:
        """Every few steps, check the guards, refine, and choose the step; ``advance`` calls it first.

        Call it first if you need the length of the next step; a second call in a step does nothing.

        Raises:
            GuardStop: the run has gone wrong, see ``guards``.
        """
        self._begin()
        if self.steps % self._interval == 0 and self.steps > self._prepared:
            self._prepared = self.steps
            self.check()
            self._refine()
            self._follow_flow()
            self.choose_time_step()

    def advance(self, at_most: float = np.inf) -> float:
        """One step, no longer than ``at_most`` seconds; returns its length.

        Raises:
            GuardStop: the run has gone wrong, see ``guards``, or a plug-in is at fault.
        """
        with self.blaming:
            return self._advance(at_most)

    def _advance(self, at_most: float) -> float:
        self.prepare()
        if not len(self.particles):
            return self._wait(min(self.time_step, at_most))
        try:
            lost = self.operations.begin(self.time)
        except Scattered as error:
            stop(self, error.particle, scattered=True)
        if lost is not None:
            stop(self, lost)
        if self.steps == 0:
            self.operations.start()
        dt = min(self.time_step, at_most)
        self.operations.step(dt)
        self.time += dt
        self.particles.time = self.time
        self.steps += 1
        self.particle_steps += len(self.particles)
        came_in = self.operations.sources.bring_in(self.time, dt, self.ledger)
        if self.drains.take_out(self.time) or came_in:
            self._renew()
        return dt

    def _wait(self, dt: float) -> float:
        """A step of an empty scene, in which something may come in."""
        self.time += dt
        self.particles.time = self.time
        self.steps += 1
        if self.operations.sources.bring_in(self.time, dt, self.ledger):
            self._renew()
        return dt

    def _renew(self) -> None:
        """Prepare for the next step after particles were added or removed."""
        try:
            self.operations.renew(self.time)
        except Scattered as error:
            stop(self, error.particle, scattered=True)

    def _begin(self) -> None:
        """Record the initial amounts, once."""
        self.ledger.begin(self.particles, self.time)
        self.guards.begin()

    def _follow_flow(self) -> None:
        """Recompute the sound speeds that follow the flow."""
        case, elapsed = self.case, self._interval * self.time_step
        goes_on = self.operations.sources.goes_on(self.time)
        driving = case.gravity_vector, case.largest_forces
        follow_flow(self.particles, self.grid, *driving, self._first_sound_speeds, elapsed, goes_on)

    def _refine(self) -> None:
        """Let the refinement split and merge particles."""
        if not self.refiner.acts or not len(self.particles):
            return
        p = self.particles
        before, height = present(p), self.ledger.height(p)
        try:
            with self.blaming:
                changed = self.refiner.refine()
        except OutOfMemory as error:
            stop(self, error.particle, drawn_out=True)
        if changed:
            self.ledger.refined(before, height, p)
            with self.blaming:
                self._renew()

    def measured(self) -> dict[str, float | np.ndarray]:
        """The scalars of the history at the present step, by the names of the variables."""
        found = self.measures(self.particles) | {
            "redistribution_energy": self.redistribution_energy,
            "time_step": self.time_step,
            "mach_number": self.mach_number,
        }
        if self.case.sources:
            found["mass_in"] = float(self.operations.sources.mass_in.sum())
        if self.case.sinks:
            found["mass_out"] = float(self.ledger.mass_out.sum())
        with self.blaming:
            return found | diagnosed(self)

    def account(self) -> np.ndarray:
        """Mass, momentum and energy by cause, ``(causes, 2 + dim)``, see ``ledger.Ledger``."""
        dim, stage, sources = self.grid.dim, self.operations.stage, self.operations.sources
        forces = self.operations.forces
        by_cause = {
            FORCES: (forces.impulse.sum(axis=0), float(forces.work.sum())),
            WALLS: (self._impulse_of_walls(dim), self.walls_work),
            REDISTRIBUTION: (stage.momentum, stage.energy),
            IN: (sources.impulse, sources.work),
        }
        return self.ledger.account(self.particles, self.time, by_cause)

    def _impulse_of_walls(self, dim: int) -> np.ndarray:
        """Impulse of all walls, faces and planes of symmetry so far, N s, ``(dim,)``."""
        impulse = self.operations.faces.sums[:, :dim].sum(axis=0)
        if len(self.operations.walls):
            impulse += self.operations.walls.sums()[:, :dim].sum(axis=0)
        return impulse

    @property
    def mapped_mass(self) -> float | None:
        """Mass mapped to the nodes in the last step, kg; None before the first step."""
        return self.operations.mapped_mass

    @property
    def wall_names(self) -> tuple[str, ...]:
        """Walls of the case, then the faces of the grid that are walls."""
        return *self.case.walls, *self.operations.faces.names

    def wall_sums(self) -> np.ndarray:
        """Impulse, moment of impulse, and work of each wall on the material so far, ``(walls, …)``."""
        return np.array([*self.operations.walls.sums(), *self.operations.faces.of_walls()])

    @property
    def walls_work(self) -> float:
        """Work of moving walls on the material so far, J."""
        return self.operations.walls.work

    @property
    def settled(self) -> bool:
        """Whether no force changes any more."""
        with self.blaming:
            return all(settles(force) <= self.time for force in self.case.varying_forces.values())

    @property
    def force_work(self) -> np.ndarray:
        """Work of each force that is not constant on the material so far, J."""
        return self.operations.forces.work

    @property
    def redistribution_energy(self) -> float:
        """Energy added by redistributions so far, J; see ``redistribution.Stage``."""
        return self.operations.stage.energy

    def require_tables(self) -> None:
        """Raise PluginFault if the weights of the last step, if any, are wrong."""
        if self.mapped_mass is not None:
            self.operations.require_tables()

    def sum_of_weights(self) -> np.ndarray:
        """Σ N of every particle, ``(n,)``, of the last step; 1 up to rounding."""
        return np.prod(self.operations.weight.sum(axis=-1), axis=1)

    def check(self) -> None:
        """Raise GuardStop if the run has gone wrong, see ``guards``."""
        with self.blaming:
            self._begin()
            self.ledger.look(self.particles, self.time)
            self.guards.check()
