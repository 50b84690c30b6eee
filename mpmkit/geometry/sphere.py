"""The sphere."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from ..contracts.base import quantity
from ..spaces import Space
from .base import Shape, disc_area, squared_distance
from .distance import Ball, Solid
from .revolved import part_of_revolved


class Sphere(Shape):
    """Sphere, V = 4/3 π R³; a disc in plane strain. In an axisymmetric scene its centre is [0, z]."""

    kind: Literal["sphere"]
    centre: list[float] = quantity("m", "centre", min_length=2, max_length=3)
    radius: float = quantity("m", "radius", gt=0)

    turned = True

    def _middle(self) -> tuple[float, float]:
        return self.centre[0], self.centre[1]

    def _problem(self, space: Space) -> str | None:
        return self._wrong_length("centre", self.centre, space) or self._off_axis(
            "centre", self.centre, space
        )

    def _solid(self, space: Space) -> Solid:
        return Ball(np.array(self.centre, dtype=float), self.radius)

    def _bounds(self, space: Space) -> tuple[list[float], list[float]]:
        lower = [x - self.radius for x in self.centre]
        return [0.0, *lower[1:]] if space.radial else lower, [x + self.radius for x in self.centre]

    def _contains(self, points: np.ndarray, space: Space, tolerance: float) -> np.ndarray:
        return squared_distance(points, self.centre) <= (self.radius + tolerance) ** 2

    def _size(self, space: Space) -> float:
        if space.dim == 3:
            return self._volume(space)
        return disc_area(self.radius) / (2 if space.radial else 1)

    def _volume(self, space: Space) -> float:
        if space.dim == 2 and not space.radial:
            return disc_area(self.radius)
        return 4 / 3 * math.pi * self.radius**3

    def _volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        *middle, height = self.centre

        def heights(radius: float) -> list[float]:
            half = math.sqrt(max(self.radius**2 - radius**2, 0.0))
            return [height - half, height + half]

        def radius(z: np.ndarray) -> np.ndarray:
            return np.sqrt(np.maximum(self.radius**2 - (z - height) ** 2, 0.0))

        return part_of_revolved(radius, heights, middle, lower, upper, space)
