"""The energy balance of a scene: kinetic and stored energy, compared with the energy supplied."""

from __future__ import annotations

import math

import numpy as np

from ..kernels.sums import kinetics
from .grid import Grid
from .ledger import FORCES, GRAVITY, IN, OUT, REDISTRIBUTION, REFINEMENT, START, WALLS
from .particles import Particles
from .stateful import State, plain_state, restore_plain

CREATED = 0.2
"""A run stops if the created energy, relative to the supplied energy, exceeds this in several checks."""
CREATED_BY_IMPACT = 0.02
"""The same after a hard impact if all materials are solids: there, no correction of positions adds energy.
Energy that update orders create in slower motion is reported at the end and does not stop the run: USF and
MUSL with FLIP created 1 to 7 % at a tenth to a fifth of the wave speed."""
HARD = 0.25
"""An impact is hard if the speed of the solid over its wave speed exceeds this: strains are then large."""
LOOKS = 10
"""Consecutive checks in which the limit may be exceeded before the run stops."""
MOST_CREATED = 1.0
"""A run stops at once above this. For a wave of frequency ω, an explicit step conserves
(v² + ω²x² - ωΔt v ωx)/2, so that K + U can rise to 1/(1 - ωΔt/2) times its initial value: by a factor of 2
for the shortest wave at half the critical step."""

ROUNDING = 1e-9
"""Negligible energy, relative to the kinetic energy at the speed of the fastest wave."""


class EnergyBalance:
    """Compares the energy of a scene with the ledger.

    Materials dissipate, so that kinetic and stored energy cannot exceed the energy in the ledger,

        created = (K + U) - start - in - out - W <= 0,

    with K the kinetic energy, U the energy stored in shape and pressure, and W the work of gravity, of
    forces and of moving walls plus the changes by refinement, see ``ledger.Ledger``.
    Energy added by a redistribution, R, counts as created: a redistribution that adds more than the material
    dissipates stops the run like any other fault. R is recorded separately to name the cause;
    ``created - redistributed`` is the energy created by the rest of the scheme.
    Splitting gives part of the affine velocity to the halves; this counts as supplied. A sound speed that
    follows the flow changes at constant U, see ``solver.sound``, and needs no allowance.

    Attributes:
        solid: whether all materials are solids.
        redistributed: R, J.
        most_excess: largest energy created so far, over the supply.
    """

    def __init__(self, particles: Particles, grid: Grid, strength: float) -> None:
        """``strength``, m/s², of gravity and forces."""
        self._first = self._most_work = 0.0
        self.held = self.created = self.redistributed = 0.0
        self.solid = not any(group.law.uses_equation_of_state for group in particles.groups)
        self.most_excess = 0.0
        self._hard = False
        self._looks_too_high = 0
        self._wave_speed = max(group.wave_speed for group in particles.groups)
        falling = strength * grid.cell_size
        # Negligible: the energy of a fall by one cell or, without gravity, of rounding.
        self._negligible = falling + ROUNDING * self._wave_speed**2
        self._least = float(np.sum(particles.mass)) * self._negligible

    def state(self) -> State:
        """All its numbers."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Restore its numbers."""
        restore_plain(self, state)

    def update(self, p: Particles, energy: np.ndarray) -> None:
        """Record the energies by cause, J, of the present state."""
        self._first, self.redistributed = float(energy[START]), float(energy[REDISTRIBUTION])
        self._least = max(self._least, float(np.sum(p.mass)) * self._negligible)
        self.held = float(energy.sum())
        work = float(energy[[IN, GRAVITY, FORCES, WALLS, REFINEMENT]].sum())
        self._most_work = max(self._most_work, abs(work))
        self.created = self.held - self._first - work - float(energy[OUT])
        self.most_excess = max(self.most_excess, self.excess)
        if self.solid and not self._hard:
            self._hard = math.sqrt(kinetics(p.mass, p.velocity)[2]) > HARD * self._wave_speed
        tolerated = CREATED_BY_IMPACT if self._hard else CREATED
        self._looks_too_high = self._looks_too_high + 1 if self.excess > tolerated else 0

    @property
    def supply(self) -> float:
        """Energy supplied to the scene, J: at the start, and as work, up to its largest value."""
        return self._first + self._most_work + self._least

    @property
    def excess(self) -> float:
        """Created energy, relative to the supplied energy."""
        return self.created / self.supply if self.supply else 0.0  # nothing has come in yet

    @property
    def broken(self) -> bool:
        """Whether far too much energy was created, or too much for too long."""
        return self._looks_too_high >= LOOKS or not self.excess <= MOST_CREATED
