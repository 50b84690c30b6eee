"""The sources of a scene."""

from __future__ import annotations

import numpy as np

from ..case.model import Case
from .feed import Feed
from .grid import Grid, Window
from .ledger import Ledger, present
from .particles import Particles
from .sorting import Sorting
from .stateful import State, Stateful, restore, state_of


class Sources:
    """All sources of a case: before a step their columns, in it their nodes, after it new particles."""

    def __init__(self, case: Case, grid: Grid, window: Window, particles: Particles) -> None:
        first = len(case.bodies)
        self._names = tuple(case.sources)
        self.feeds = [Feed(case, name, first + k, grid, window) for k, name in enumerate(self._names)]
        self._particles = particles

    def __len__(self) -> int:
        return len(self.feeds)

    @property
    def components(self) -> dict[str, Stateful]:
        """The components with a state."""
        return dict(zip(self._names, self.feeds, strict=True))

    def state(self) -> State:
        """The states of its sources."""
        return state_of(self.components)

    def restore(self, state: State) -> None:
        """Restore the states of its sources."""
        restore(self.components, state)

    @property
    def mass_in(self) -> np.ndarray:
        """Mass that each source has brought in, kg."""
        return np.array([feed.mass_in for feed in self.feeds])

    @property
    def mapped_mass(self) -> float:
        """Mass of the columns at the nodes in the last step, kg."""
        return float(sum(feed.mapped_mass for feed in self.feeds))

    @property
    def impulse(self) -> np.ndarray:
        """Impulse of the columns on the particles, N s, without the momentum of what has come in."""
        return sum((feed.impulse for feed in self.feeds), start=np.zeros(self._particles.dim))

    @property
    def work(self) -> float:
        """Work of this impulse, J."""
        return float(sum(feed.work for feed in self.feeds))

    def fastest(self, t0: float, t1: float) -> float:
        """Upper bound of the speed of all columns between two times, m/s."""
        return max((feed.fastest(t0, t1) for feed in self.feeds), default=0.0)

    def goes_on(self, time: float) -> bool:
        """Whether any source has not ended by a time, s."""
        return any(feed.goes_on(time) for feed in self.feeds)

    def begin(self, time: float, dt: float, sorting: Sorting) -> None:
        """Prepare the columns before a step of ``dt`` s."""
        if not self.feeds:
            return
        for feed in self.feeds:
            feed.begin(time, dt, self._particles, sorting.active.mask)

    def map(self, momentum: bool, forces: bool, acceleration: np.ndarray) -> None:
        """Add the columns to the nodes; they feel the mean ``acceleration``, m/s², ``(k, dim)``."""
        mean = acceleration.mean(axis=0, keepdims=True) if self.feeds else acceleration
        for feed in self.feeds:
            feed.map(momentum, forces, mean)

    def carry(self, dt: float | None = None) -> None:
        """Give the nodes behind the mouths the velocity of their columns."""
        for feed in self.feeds:
            feed.carry(dt)

    def taken_up(self, flip: float) -> None:
        """Count the impulse and the work that the particles take from the nodes behind the mouths."""
        for feed in self.feeds:
            feed.taken_up(flip)

    def bring_in(self, time: float, dt: float, ledger: Ledger) -> bool:
        """Add the rows that have passed the mouths after a step of ``dt`` s; return whether there are any."""
        if not any(feed.due(time, dt) for feed in self.feeds):
            return False
        p = self._particles
        before, height, mass = present(p), ledger.height(p), float(self.mass_in.sum())
        for feed in self.feeds:
            feed.enter(time, dt, p)
        ledger.brought_in(before, height, p, float(self.mass_in.sum()) - mass, time)
        return True
