"""Contract of an update order: the algorithm of one step, in named operations."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar

from .base import Plugin
from .operations import Operations


class UpdateOrder(Plugin):
    """When the stress is updated within a step."""

    acoustic_fraction: ClassVar[float] = 1.0
    """Largest part of the acoustic limit, dx/c, at which the order is stable."""
    viscous_fraction: ClassVar[float] = 1.0
    """Largest part of the viscous limit, 0.375 rho dx²/mu, at which the order is stable."""

    @abstractmethod
    def step(self, ops: Operations, dt: float) -> None:
        """Take the scene forward by ``dt`` seconds."""
