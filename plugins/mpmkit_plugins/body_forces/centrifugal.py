"""Material that turns with an apparatus at a constant rate."""

from __future__ import annotations

import math
from itertools import product

import numpy as np

from mpmkit.contracts import BodyForce, Space, hookimpl, quantity

from .vectors import wrong_length


class Centrifugal(BodyForce):
    """The centrifugal term alone, a = rate² r, with r the vector from the axis, whose direction is in space.

    It is right for material that moves little compared with ω r relative to the apparatus, because the
    Coriolis term is left out. In an axisymmetric scene the axis is the axis of symmetry.
    """

    name = "centrifugal"
    api_version = 2
    citation = "Landau & Lifshitz, Mechanics, 3rd ed., Butterworth-Heinemann (1976), section 39"

    rate: float = quantity("rad/s", "angular velocity")
    point: list[float] | None = quantity(
        "m", "a point of the axis; default: the origin", default=None, min_length=2, max_length=3
    )
    direction: list[float] | None = quantity(
        "1", "direction of the axis; default: the last axis of the space", default=None,
        min_length=2, max_length=3,
    )  # fmt: skip

    def problem(self, space: Space) -> str | None:
        for field in ("point", "direction"):
            vector = getattr(self, field)
            if vector is not None and (said := wrong_length(field, vector, space)):
                return said
            if vector is not None and space.radial and vector[0] != 0:
                return f"{field} is {vector}; in the space {space.name} it must be [0, z], on the axis"
        if self.direction is not None and not any(self.direction):
            return f"direction is {self.direction}; it must have a length"
        return None

    def acceleration(self, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
        dim = x.shape[1]
        axis = np.eye(dim)[-1] if self.direction is None else np.array(self.direction)
        axis = axis / np.linalg.norm(axis)
        r = x - (np.zeros(dim) if self.point is None else np.array(self.point))
        return self.rate**2 * (r - np.outer((r * axis).sum(axis=1), axis))

    def largest(self, lower: np.ndarray, upper: np.ndarray, t0: float, t1: float) -> np.ndarray:
        """It is linear in r, and so largest at a corner."""
        corners = np.array(list(product(*zip(lower, upper, strict=True))))
        return np.abs(self.acceleration(corners, np.zeros_like(corners), t0)).max(axis=0)

    def settles(self) -> float:
        return -math.inf

    def shortest_period(self) -> float:
        return 2 * math.pi / abs(self.rate) if self.rate else math.inf


@hookimpl
def mpmkit_body_forces() -> list[type[BodyForce]]:
    return [Centrifugal]
