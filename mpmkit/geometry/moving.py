"""A moving solid as the surface of a wall."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..contracts.solid import Solid
from .motion import Hull, Motion


@dataclass(frozen=True)
class MovingSolid:
    """A solid wall in its rigid motion, a ``PlacedSurface`` of the contracts.

    Args:
        solid: the wall in its initial position.
        motion: None for a wall at rest.
        appears, vanishes: s; it exists between these times. None: from the start, without end.
        thickness: m; infinite for a wall with material on one side only.
        radial: whether the first coordinate is the radius.
        within: the solid of which it is a part, and with which it moves; None if it is not a part.
    """

    solid: Solid
    motion: Motion | None = None
    appears: float | None = None
    vanishes: float | None = None
    thickness: float = math.inf
    radial: bool = False
    within: Solid | None = None

    @cached_property
    def _hull(self) -> Hull:
        """The hull of the solid; a point for a solid without an end, which cannot turn."""
        return (self.within or self.solid).hull() or (np.zeros((1, 1)), 0.0)

    @cached_property
    def parts(self) -> tuple[MovingSolid, ...]:
        """Walls whose union is this one, each without inner edges."""
        return tuple(replace(self, solid=part, within=self.solid) for part in self.solid.parts(self.radial))

    def distance(self, x: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
        """d, m, (k,), and n, (k, dim), at points in the scene, m, (k, dim), at a time, s."""
        if self.motion is None:
            return self.solid.distance(x)
        distance, normal = self.solid.distance(self.motion.back(x, t))
        return distance, self.motion.turned(normal, t)

    def velocity(self, x: np.ndarray, t: float) -> np.ndarray:
        """m/s, (k, dim), of the wall at the points of its surface nearest to ``x``."""
        if self.motion is None:
            return np.zeros(x.shape)
        if not self.motion.turns:
            return self.motion.velocities(x, t)
        distance, normal = self.distance(x, t)
        return self.motion.velocities(x - distance[:, None] * normal, t)

    def fastest(self, t0: float, t1: float) -> float:
        """Upper bound, m/s, of the velocity between two times, s."""
        if self.motion is None:
            return 0.0
        return self.motion.fastest(t0, t1, self._hull)

    def present(self, t: float) -> bool:
        """Whether it exists at a time, s."""
        return (self.appears is None or t >= self.appears) and (self.vanishes is None or t < self.vanishes)
