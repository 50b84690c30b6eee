"""The sphere, which may be hollow."""

from __future__ import annotations

import math

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import BodyShape, Space, hookimpl, quantity
from mpmkit.geometry import Ball, Solid, part_of_revolved

from .lengths import off_axis, squared_distance, wrong_length


class Sphere(BodyShape):
    """Sphere, V = 4/3 π (R³ − R_i³); a disc or a ring in plane strain. In an axisymmetric scene its centre is
    [0, z]."""

    name = "sphere"
    api_version = 2
    citation = "none: elementary geometry"

    centre: list[float] = quantity("m", "centre", min_length=2, max_length=3)
    radius: float = quantity("m", "radius", gt=0)
    inner_radius: float = quantity("m", "radius of a hollow in its middle; default: none", default=0.0, ge=0)

    turned = True

    @model_validator(mode="after")
    def _has_volume(self) -> Sphere:
        if self.inner_radius >= self.radius:
            raise ValueError(f"inner_radius is {self.inner_radius}; it must be below radius, {self.radius}")
        return self

    @property
    def _radii(self) -> tuple[float, ...]:
        return (self.radius, self.inner_radius) if self.inner_radius else (self.radius,)

    def middle(self, space: Space) -> tuple[float, float] | None:
        return (self.centre[0], self.centre[1]) if space.dim == 3 else None

    def problem(self, space: Space) -> str | None:
        given = (self, "centre", self.centre, space)
        return wrong_length(*given) or off_axis(*given)

    def solid(self, space: Space) -> Solid:
        return Ball(np.array(self.centre, dtype=float), self.radius, self.inner_radius)

    def bounds(self, space: Space) -> tuple[np.ndarray, np.ndarray]:
        lower, upper = np.array(self.centre) - self.radius, np.array(self.centre) + self.radius
        if space.radial:
            lower[0] = 0.0
        return lower, upper

    def signed_distance(self, x: np.ndarray, space: Space) -> np.ndarray:
        return self.solid(space).distance(x)[0]

    def within(self, x: np.ndarray, space: Space, tolerance: float) -> np.ndarray:
        square = squared_distance(x, self.centre)
        within = max(self.inner_radius - tolerance, 0.0)
        return (square <= (self.radius + tolerance) ** 2) & (square >= within**2)

    def size(self, space: Space) -> float:
        if space.dim == 3:
            return self.volume(space)
        return self._ring() / (2 if space.radial else 1)

    def volume(self, space: Space) -> float:
        if space.dim == 2 and not space.radial:
            return self._ring()
        return 4 / 3 * math.pi * (self.radius**3 - self.inner_radius**3)

    def _ring(self) -> float:
        return math.pi * (self.radius**2 - self.inner_radius**2)

    def volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        outer, *inner = (self._part(radius, lower, upper, space) for radius in self._radii)
        return outer - sum(inner)

    def _part(self, outer: float, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        """Volume of the part of a full sphere between two corners, m³."""
        *middle, height = self.centre

        def heights(radius: float) -> list[float]:
            half = math.sqrt(max(outer**2 - radius**2, 0.0))
            return [height - half, height + half]

        def radius(z: np.ndarray) -> np.ndarray:
            return np.sqrt(np.maximum(outer**2 - (z - height) ** 2, 0.0))

        low, high = np.array(lower, dtype=float), np.array(upper, dtype=float)
        low[-1], high[-1] = max(low[-1], height - outer), min(high[-1], height + outer)
        if low[-1] >= high[-1]:
            return 0.0
        return part_of_revolved(radius, heights, middle, low, high, space)


@hookimpl
def mpmkit_body_shapes() -> list[type[BodyShape]]:
    return [Sphere]
