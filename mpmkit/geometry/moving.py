"""A solid that moves: what a surface of a solid is in its space."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .distance import Solid
from .motion import Hull, Motion


@dataclass(frozen=True)
class MovingSolid:
    """A solid wall in its rigid motion, a ``PlacedSurface`` of the contracts.

    Args:
        solid: the wall, where it is without its motion.
        motion: None for a wall at rest.
        appears, vanishes: s; it is there from the one to the other. None: from the start, for ever.
        thickness: m; infinite for a wall that has material on one of its sides only.
        radial: whether the first coordinate is the radius.
        within: the solid of which it is a part, and whose points it moves with; None: it is no part.
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
        """That of the solid; of one without an end, which cannot turn, a place."""
        return (self.within or self.solid).hull() or (np.zeros((1, 1)), 0.0)

    @cached_property
    def parts(self) -> tuple[MovingSolid, ...]:
        """Walls that are together this one, each without inner edges."""
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
        """Whether it is there at a time, s."""
        return (self.appears is None or t >= self.appears) and (self.vanishes is None or t < self.vanishes)
