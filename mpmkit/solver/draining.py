"""Removal of material by sinks."""

from __future__ import annotations

import numpy as np

from ..case.model import Case
from ..errors import PluginFault
from ..registry.audit import described
from .grid import Grid
from .ledger import Ledger, present
from .particles import Particles


class Drains:
    """The sinks of a case, which act after every step.

    Attributes:
        emptied: names the sinks that would remove all of a material, so that the run must end; empty before
            that. The last particles of a material stay, and do not count as removed.
    """

    def __init__(self, case: Case, grid: Grid, particles: Particles, ledger: Ledger) -> None:
        self._sinks = case.sinks
        self._domain = case.domain_bounds
        self._lower = grid.lower
        self._particles, self._ledger = particles, ledger
        self.emptied = ""

    def state(self) -> dict[str, np.ndarray]:
        """The sentence ``emptied``."""
        return {"emptied": np.array(self.emptied)}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore the state."""
        self.emptied = str(state["emptied"])

    def take_out(self, time: float) -> bool:
        """Remove the particles in the sinks, and record them; return whether any was removed.

        Raises:
            PluginFault: a sink does not return which particles it takes.
        """
        if not self._sinks:
            return False
        p, ledger = self._particles, self._ledger
        by = self._by(time)
        stays = by < 0
        if stays.all():
            return False
        if any(len(stays[group.part]) and not stays[group.part].any() for group in p.groups):
            names = list(self._sinks)
            used = " and ".join(f"sinks.{names[index]}" for index in np.unique(by[~stays]))
            self.emptied = f"all of a material has left through {used}"
            return False
        before, height = present(p), ledger.height(p)
        masses = np.bincount(by[~stays], p.mass[~stays], minlength=len(self._sinks))
        p.take(np.flatnonzero(stays))
        ledger.taken_out(before, height, p, masses, time)
        return True

    def _by(self, time: float) -> np.ndarray:
        """Index of the sink that takes each particle, ``(n,)``, the first one if several do; -1 for none."""
        position = self._particles.position + self._lower
        found = np.full(len(position), -1)
        for index, sink in enumerate(self._sinks.values()):
            takes = sink.takes(position.copy(), time, self._domain)
            if not isinstance(takes, np.ndarray) or takes.dtype != bool or takes.shape != found.shape:
                what = described(takes) + (f" of {takes.dtype}" if isinstance(takes, np.ndarray) else "")
                must = f"it must be an array of True and False of shape {found.shape}"
                raise PluginFault(sink, f"returned {what} from takes; {must}")
            found[takes & (found < 0)] = index
        return found
