"""The forces of a case on the particles of a scene: their accelerations, impulses and work."""

from __future__ import annotations

import numpy as np

from ..case.model import Case
from ..registry.audit import forces as audit
from .grid import Grid
from .particles import Particles
from .stateful import State, plain_state, restore_plain

ROUNDS = 3
"""Evaluations in a step of forces that depend on the velocity, so that the Coriolis force does no work: from
one to the next, the velocity in the middle of the step is improved by a factor of ω Δt."""


class Forces:
    """Constant gravity and the forces of a case.

    Particle p gets the force m_p a_p, a_p the mean acceleration over the step at its place x_p at the start
    of the step and for its velocity in the middle of it. The nodes get f = Σ m_p a_p N_p, as from gravity.
    The work of a force in a step is what it gives to the nodes,

        W = Δt Σ m_p a_p·v̄_p,   v̄_p = Σ N_p (v_I + v_I + Δv_I)/2,

    with the velocities v_I of the nodes before and v_I + Δv_I after the momentum equation.

    Attributes:
        acceleration: m/s², ``(n, dim)``, of all particles in this step with gravity; ``(1, dim)`` if all have
            the same.
        impulse: N s, ``(forces, dim)``, given so far by each force that is not constant.
        work: J, ``(forces,)``, done so far by each of them.
    """

    def __init__(self, case: Case, grid: Grid, particles: Particles) -> None:
        self._forces = list(case.varying_forces.values())
        self._gravity = case.gravity_vector
        self._lower = grid.lower
        self._particles = particles
        self._uniform = all(force.uniform for force in self._forces)
        self._of_velocity = any(force.of_velocity for force in self._forces)
        self.impulse = np.zeros((len(self._forces), grid.dim))
        self.work = np.zeros(len(self._forces))
        self._forget()

    def __len__(self) -> int:
        return len(self._forces)

    def _forget(self) -> None:
        self.acceleration = self._gravity[None].copy()
        self._each = np.zeros((0, 1, len(self._gravity)))  # m/s², of each force

    def state(self) -> State:
        """Impulses and work."""
        return plain_state(self, but=("acceleration", "_each"))

    def restore(self, state: State) -> None:
        """Restore impulses and work."""
        restore_plain(self, state)
        self._forget()

    def act(self, time: float, dt: float) -> None:
        """Compute the accelerations in a step of ``dt`` s from a time, s."""
        if not self._forces:
            return
        p = self._particles
        x = p.position[:1] if self._uniform else p.position
        x, v = x + self._lower, p.velocity[: len(x)]
        middle = v
        for _ in range(ROUNDS if self._of_velocity else 1):
            self._each = np.array([self._one(force, x, middle, time, dt) for force in self._forces])
            self.acceleration = self._gravity + self._each.sum(axis=0)
            middle = v + dt / 2 * self.acceleration

    def _one(self, force, x: np.ndarray, v: np.ndarray, time: float, dt: float) -> np.ndarray:
        """The acceleration of one force at all places, m/s²."""
        asked = slice(0, 1) if force.uniform else slice(None)
        found = audit.mean_acceleration(force, x[asked], v[asked], time, time + dt)
        return np.broadcast_to(found, x.shape)

    def count(self, doubled: np.ndarray, dt: float) -> None:
        """Add up impulses and work of a step of ``dt`` s; ``doubled`` is 2 v̄ of all particles, m/s."""
        mass = self._particles.mass
        momentum = np.einsum("p,pd->d", mass, doubled) / 2
        for k, a in enumerate(self._each):
            if self._uniform:
                self.impulse[k] += dt * mass.sum() * a[0]
                self.work[k] += dt * float((momentum * a[0]).sum())
            else:
                self.impulse[k] += dt * np.einsum("p,pd->d", mass, a)
                self.work[k] += dt * float(np.einsum("p,pd,pd->", mass, a, doubled)) / 2
