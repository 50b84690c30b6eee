"""The energy balance of a scene: what moves and is stored, against what was put in."""

from __future__ import annotations

import math

import numpy as np

from ..kernels.sums import kinetics
from .grid import Grid
from .ledger import GRAVITY, IN, OUT, REDISTRIBUTION, REFINEMENT, START, WALLS
from .particles import Particles
from .stateful import State, plain_state, restore_plain

CREATED = 0.2
"""Created energy, relative to the energy that the scene had to move, that stops a run after some checks."""
CREATED_BY_IMPACT = 0.02
"""The same after a hard impact where all materials are solids: nothing pushes their particles apart, which
takes energy from nowhere. What update orders create in slower motion is told at the end, and not stopped:
1 to 7 % of it came from USF and MUSL with FLIP at a tenth to a fifth of the wave speed."""
HARD = 0.25
"""Speed of a solid over its wave speed from which an impact is a hard one: strains are then finite."""
LOOKS = 10
"""Looks in a row at which there may be as much."""
MOST_CREATED = 1.0
"""What is not taken at all. Of a wave of frequency ω an explicit step conserves (v² + ω²x² - ωΔt v ωx)/2, so
that K + U goes up to 1/(1 - ωΔt/2) of what it was: twice, for the shortest wave at half the critical step."""

ROUNDING = 1e-9
"""Energy that is nothing, over that of flying at the speed of the fastest wave."""


class EnergyBalance:
    """Compares the energy of a scene with the ledger.

    Materials dissipate, so that what moves and is stored can be no more than what the ledger accounts for,

        created = (K + U) - start - in - out - W <= 0,

    with K the kinetic energy, U what is stored in shape and in pressure, and W the work of gravity and of
    walls that move, and what refinement has changed, see ``ledger.Ledger``.
    What a redistribution has put in, R, is a part of what was created, and is not excused: one that feeds
    more than the material dissipates is stopped like any other fault. It is kept apart to name the cause,
    and ``created - redistributed`` is what the rest of the scheme has created.
    Splitting leaves part of the affine velocity to the halves: that is taken as put in. A sound speed that
    follows the flow changes at the same U, see ``solver.sound``, and is forgiven nothing.

    Attributes:
        solid: whether all materials are solids.
        redistributed: R, J.
        most_excess: largest energy created so far, over the supply.
    """

    def __init__(self, particles: Particles, grid: Grid, gravity: np.ndarray) -> None:
        self._first = self._most_work = 0.0
        self.held = self.created = self.redistributed = 0.0
        self.solid = not any(group.law.uses_equation_of_state for group in particles.groups)
        self.most_excess = 0.0
        self._hard = False
        self._looks_too_high = 0
        mass = float(np.sum(particles.mass))
        self._wave_speed = max(group.wave_speed for group in particles.groups)
        falling = float(np.linalg.norm(gravity)) * grid.cell_size
        # What a scene gains by falling one cell, or, without gravity, by rounding: so much is nothing.
        self._least = mass * (falling + ROUNDING * self._wave_speed**2)

    def state(self) -> State:
        """All its numbers."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Take its numbers back."""
        restore_plain(self, state)

    def update(self, p: Particles, energy: np.ndarray) -> None:
        """Take the energies by cause, J, of the present state."""
        self._first, self.redistributed = float(energy[START]), float(energy[REDISTRIBUTION])
        self.held = float(energy.sum())
        work = float(energy[[IN, GRAVITY, WALLS, REFINEMENT]].sum())
        self._most_work = max(self._most_work, abs(work))
        self.created = self.held - self._first - work - float(energy[OUT])
        self.most_excess = max(self.most_excess, self.excess)
        if self.solid and not self._hard:
            self._hard = math.sqrt(kinetics(p.mass, p.velocity)[2]) > HARD * self._wave_speed
        tolerated = CREATED_BY_IMPACT if self._hard else CREATED
        self._looks_too_high = self._looks_too_high + 1 if self.excess > tolerated else 0

    @property
    def supply(self) -> float:
        """Energy that the scene had to move with, J: at the start, and from gravity at its most."""
        return self._first + self._most_work + self._least

    @property
    def excess(self) -> float:
        """Energy created, over the supply."""
        return self.created / self.supply

    @property
    def broken(self) -> bool:
        """Whether far too much energy was created, or too much for too long."""
        return self._looks_too_high >= LOOKS or not self.excess <= MOST_CREATED
