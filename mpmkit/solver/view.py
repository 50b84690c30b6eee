"""Read-only view of a scene."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ..case.model import Case
from .grid import Grid
from .ledger import Ledger
from .particles import Particles
from .time_step import Limits


class SceneView(Protocol):
    """Read-only view of a scene for guards. ``Simulation`` implements it."""

    @property
    def case(self) -> Case: ...

    @property
    def grid(self) -> Grid: ...

    @property
    def particles(self) -> Particles: ...

    @property
    def time(self) -> float:
        """s"""

    @property
    def steps(self) -> int:
        """Steps done."""

    @property
    def time_step(self) -> float:
        """s, of the next step."""

    @property
    def limits(self) -> Limits: ...

    @property
    def limited_by(self) -> str:
        """The limit that sets the step."""

    @property
    def mapped_mass(self) -> float | None:
        """Mass mapped to the nodes in the last step, kg; None before the first step."""

    @property
    def ledger(self) -> Ledger: ...

    def account(self) -> np.ndarray:
        """Mass, momentum and energy by cause, ``(causes, 2 + dim)``, see ``ledger.Ledger``."""

    def require_tables(self) -> None:
        """Raise PluginFault if the weights of the last step are wrong."""

    def sum_of_weights(self) -> np.ndarray:
        """Σ N of every particle, ``(n,)``, of the last step."""
