"""Contract of a velocity update: how the nodal velocities come back to the particles."""

from __future__ import annotations

from abc import abstractmethod

from .base import Plugin
from .operations import Operations


class VelocityUpdate(Plugin):
    """Moves the particles and updates their velocities from the nodes."""

    @abstractmethod
    def map_to_particles(self, ops: Operations, dt: float) -> None:
        """Update positions and velocities, by ``ops.advance`` or by mappings of its own."""
