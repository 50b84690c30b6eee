"""Contract of a velocity update: how the nodal velocities come back to the particles."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar

from .base import Plugin
from .operations import Operations


class VelocityUpdate(Plugin):
    """Moves the particles and updates their velocities from the nodes."""

    acoustic_fraction: ClassVar[float] = 1.0
    """Largest part of the acoustic limit, dx/c, at which the update is stable."""
    affine: ClassVar[bool] = False
    """Whether particles keep the affine part of the velocity around them and map it to the nodes as well."""

    @abstractmethod
    def map_to_particles(self, ops: Operations, dt: float) -> None:
        """Update positions and velocities, by ``ops.move_particles`` or by mappings of its own."""
