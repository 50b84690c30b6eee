"""Contract of an update order: the algorithm of one step, in named operations."""

from __future__ import annotations

from abc import abstractmethod

from .base import Plugin
from .operations import Operations


class UpdateOrder(Plugin):
    """When the stress is updated within a step."""

    @abstractmethod
    def step(self, ops: Operations, dt: float) -> None:
        """Advance the scene by ``dt`` seconds."""
