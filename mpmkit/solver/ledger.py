"""The ledger of a scene: mass, momentum and energy, and the cause of each change.

The present amount of each is the sum over the causes. The cause "rest" is rounding for mass and momentum (for
momentum along r: the impulse of the hoop stress), and for energy the dissipation by the material plus gains
and losses of the scheme.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .energies import compressive_energy, kinetic_energy, potential_energy, strain_energy, weighted
from .grid import Grid
from .particles import Particles
from .stateful import State, plain_state, restore_plain

CAUSES = ("start", "in", "out", "gravity", "forces", "walls", "refinement", "redistribution", "rest")
"""Causes of changes of mass, momentum and energy; ``out`` is negative."""
START, IN, OUT, GRAVITY, FORCES, WALLS, REFINEMENT, REDISTRIBUTION, REST = range(len(CAUSES))
MASS, ENERGY = 0, -1
"""Number of entries: mass, kg, momentum along each axis, N s, and energy, J."""


def present(p: Particles) -> np.ndarray:
    """Present amounts, ``(2 + dim,)``: mass, momentum, and kinetic plus stored energy."""
    energy = kinetic_energy(p) + strain_energy(p) + compressive_energy(p)
    momentum = (p.mass[:, None] * p.velocity).sum(axis=0)
    return np.array([float(np.sum(p.mass)), *momentum, energy])


class Ledger:
    """Keeps the ledger. Potential energy is not included; gravity appears by its work.

    Along an axis that is not periodic, this work is the loss of potential energy of the particles. Along a
    periodic axis there is no height: the work is the time integral of the power, by the trapezoidal rule
    between checks. In an axisymmetric scene, momentum along r is not conserved: its rest contains the hoop
    stress.

    Attributes:
        begun: whether the start has been written down.
        entries: ``(causes, 2 + dim)``, for the causes that are recorded when they occur.
        mass_out: kg that each sink has taken so far, in the order of the case.
    """

    def __init__(self, grid: Grid, gravity: np.ndarray, sinks: int) -> None:
        self._gravity = gravity
        self._downwards = np.where(grid.periodic, 0.0, gravity)
        self._along = np.where(grid.periodic, gravity, 0.0)
        self.begun = False
        self.entries = np.zeros((len(CAUSES), 2 + grid.dim))
        self.mass_out = np.zeros(sinks)
        self._height = 0.0  # J, the potential energy if gravity had done no work
        self._looked = self._power = self._work_along = 0.0
        self._changed = self._mass_time = 0.0  # s, time of the last change of mass; kg s, ∫ m dt up to then

    def state(self) -> State:
        """All its entries."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Restore its entries."""
        restore_plain(self, state)

    def begin(self, p: Particles, time: float) -> None:
        """Record the initial amounts, at the first call."""
        if self.begun:
            return
        self.begun = True
        self.entries[START] = present(p)
        self._height = potential_energy(p, self._downwards)
        self._looked = self._changed = time
        self._power = self._power_along(p)

    @property
    def mass(self) -> float:
        """Mass that the particles must have, kg."""
        return float(self.entries[[START, IN, OUT], MASS].sum())

    def look(self, p: Particles, time: float) -> None:
        """Add up the power of gravity along periodic axes; to be called every few steps."""
        self._work_along = self._worked_along(p, time)
        self._looked, self._power = time, self._power_along(p)

    def refined(self, before: np.ndarray, height: float, p: Particles) -> None:
        """Record the changes by a refinement, given the amounts and the potential energy before."""
        self.entries[REFINEMENT] += present(p) - before
        self._height += potential_energy(p, self._downwards) - height

    def taken_out(
        self, before: np.ndarray, height: float, p: Particles, masses: np.ndarray, time: float
    ) -> None:
        """Record the removal by sinks, ``masses`` by each sink, given the amounts before."""
        self._mass_time += (time - self._changed) * self.mass
        self._changed = time
        self.mass_out += masses
        gone = present(p) - before
        gone[MASS] = -masses.sum()
        self.entries[OUT] += gone
        self._height += potential_energy(p, self._downwards) - height

    def brought_in(self, before: np.ndarray, height: float, p: Particles, mass: float, time: float) -> None:
        """Record what came in through sources, ``mass``, given the amounts before."""
        self._mass_time += (time - self._changed) * self.mass
        self._changed = time
        came = present(p) - before
        came[MASS] = mass
        self.entries[IN] += came
        self._height += potential_energy(p, self._downwards) - height

    def height(self, p: Particles) -> float:
        """Potential energy of the particles, J, along axes that are not periodic."""
        return potential_energy(p, self._downwards)

    def account(self, p: Particles, time: float, given: Mapping[int, tuple[np.ndarray, float]]) -> np.ndarray:
        """The whole ledger, ``(causes, 2 + dim)``, with the rest; its sum over the causes is the present
        amount.

        Args:
            p: the particles.
            time: s.
            given: momentum, N s, ``(dim,)``, and energy, J, that forces, walls, redistributions and the
                columns of sources have given so far.
        """
        now = present(p)
        if not self.begun:
            found = np.zeros_like(self.entries)
            found[START] = now
            return found
        found = self.entries.copy()
        found[GRAVITY, 1:-1] = self._gravity * (self._mass_time + (time - self._changed) * self.mass)
        worked = self._height - potential_energy(p, self._downwards)
        found[GRAVITY, ENERGY] = worked + self._worked_along(p, time)
        for cause, (momentum, energy) in given.items():
            found[cause, 1:-1] += momentum
            found[cause, ENERGY] += energy
        found[REST] = now - found[:REST].sum(axis=0)
        return found

    def _worked_along(self, p: Particles, time: float) -> float:
        return self._work_along + (time - self._looked) * (self._power_along(p) + self._power) / 2

    def _power_along(self, p: Particles) -> float:
        return weighted(p, p.velocity, self._along)
