"""The account of a scene: mass, momentum and energy, and by what each has changed.

What there is of each is the sum over the causes. Of mass the rest is rounding, of momentum what the scheme
loses, of energy what the material has dissipated and the scheme has made or lost.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .energies import compressive_energy, kinetic_energy, potential_energy, strain_energy, weighted
from .grid import Grid
from .particles import Particles
from .stateful import State, plain_state, restore_plain

CAUSES = ("start", "in", "out", "gravity", "walls", "refinement", "redistribution", "rest")
"""By what mass, momentum and energy change; ``out`` is negative."""
START, IN, OUT, GRAVITY, WALLS, REFINEMENT, REDISTRIBUTION, REST = range(len(CAUSES))
MASS, ENERGY = 0, -1
"""Entries of what there is: mass, kg, momentum along each axis, N s, and energy, J."""


def present(p: Particles) -> np.ndarray:
    """What there is, ``(2 + dim,)``: mass, momentum, and energy of motion, shape and pressure."""
    energy = kinetic_energy(p) + strain_energy(p) + compressive_energy(p)
    momentum = (p.mass[:, None] * p.velocity).sum(axis=0)
    return np.array([float(np.sum(p.mass)), *momentum, energy])


class Ledger:
    """Keeps the account. Potential energy is not in it: what gravity does is its work.

    Along an axis that is not periodic that work is what the particles have come down by. A periodic axis has
    no height: there it is the integral of its power over time, by the trapezoidal rule from look to look.
    In an axisymmetric scene momentum along r is no vector, and its rest holds the hoop stress.

    Attributes:
        begun: whether the start has been written down.
        entries: ``(causes, 2 + dim)``, of those causes that are written down when they happen.
        mass_out: kg that each sink has taken so far, in the order of the case.
    """

    def __init__(self, grid: Grid, gravity: np.ndarray, sinks: int) -> None:
        self._gravity = gravity
        self._downwards = np.where(grid.periodic, 0.0, gravity)
        self._along = np.where(grid.periodic, gravity, 0.0)
        self.begun = False
        self.entries = np.zeros((len(CAUSES), 2 + grid.dim))
        self.mass_out = np.zeros(sinks)
        self._height = 0.0  # J, the potential energy that there would be if gravity had done no work
        self._looked = self._power = self._work_along = 0.0
        self._changed = self._mass_time = 0.0  # s, since when the mass is as it is; kg s, up to then

    def state(self) -> State:
        """All its entries."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Take its entries back."""
        restore_plain(self, state)

    def begin(self, p: Particles, time: float) -> None:
        """Write down what there is at the start, the first time that it is called."""
        if self.begun:
            return
        self.begun = True
        self.entries[START] = present(p)
        self._height = potential_energy(p, self._downwards)
        self._looked = self._changed = time
        self._power = self._power_along(p)

    @property
    def mass(self) -> float:
        """kg that there must be."""
        return float(self.entries[[START, IN, OUT], MASS].sum())

    def look(self, p: Particles, time: float) -> None:
        """Add up the power of gravity along periodic axes; to be called every few steps."""
        self._work_along = self._worked_along(p, time)
        self._looked, self._power = time, self._power_along(p)

    def refined(self, before: np.ndarray, height: float, p: Particles) -> None:
        """Write down what a refinement has changed, from what there was and its potential energy."""
        self.entries[REFINEMENT] += present(p) - before
        self._height += potential_energy(p, self._downwards) - height

    def taken_out(
        self, before: np.ndarray, height: float, p: Particles, masses: np.ndarray, time: float
    ) -> None:
        """Write down what sinks have taken, ``masses`` by each of them, from what there was before."""
        self._mass_time += (time - self._changed) * self.mass
        self._changed = time
        self.mass_out += masses
        gone = present(p) - before
        gone[MASS] = -masses.sum()
        self.entries[OUT] += gone
        self._height += potential_energy(p, self._downwards) - height

    def height(self, p: Particles) -> float:
        """Potential energy of the particles, J, along axes that are not periodic."""
        return potential_energy(p, self._downwards)

    def account(self, p: Particles, time: float, given: Mapping[int, tuple[np.ndarray, float]]) -> np.ndarray:
        """The whole account, ``(causes, 2 + dim)``, with the rest: its sum over the causes is what there is.

        Args:
            p: the particles.
            time: s.
            given: momentum, N s, ``(dim,)``, and energy, J, that walls and redistributions have given so far.
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
            found[cause, 1:-1], found[cause, ENERGY] = momentum, energy
        found[REST] = now - found[:REST].sum(axis=0)
        return found

    def _worked_along(self, p: Particles, time: float) -> float:
        return self._work_along + (time - self._looked) * (self._power_along(p) + self._power) / 2

    def _power_along(self, p: Particles) -> float:
        return weighted(p, p.velocity, self._along)
