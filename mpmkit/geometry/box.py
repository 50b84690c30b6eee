"""The box along the axes of the grid; a ring in an axisymmetric scene."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np
from pydantic import model_validator

from ..contracts.base import quantity
from ..spaces import Space
from .base import Shape
from .distance import Brick, BrickShell, Solid


class Box(Shape):
    """Box between two corners, V = Π (u_a − l_a), 1 m thick in plane strain.

    In an axisymmetric scene the corners are (r, z), the box is a ring, V = π (r₁² − r₀²) h, and r₀ ≥ 0.
    """

    kind: Literal["box"]
    lower: list[float] = quantity("m", "lower corner", min_length=2, max_length=3)
    upper: list[float] = quantity("m", "upper corner", min_length=2, max_length=3)

    @model_validator(mode="after")
    def _is_ordered(self) -> Box:
        if len(self.lower) != len(self.upper) or any(
            low >= high for low, high in zip(self.lower, self.upper, strict=True)
        ):
            raise ValueError(
                f"upper is {self.upper}, but it must be above lower, {self.lower}, along each axis"
            )
        return self

    def _middle(self) -> tuple[float, float]:
        x, y, _ = ((low + high) / 2 for low, high in zip(self.lower, self.upper, strict=True))
        return x, y

    def _problem(self, space: Space) -> str | None:
        if problem := self._wrong_length("lower", self.lower, space):
            return problem
        if space.radial and self.lower[0] < 0:
            return f"the box's lower is {self.lower}, but in the space {space.name} its r must be at least 0"
        return None

    def _solid(self, space: Space) -> Solid:
        return self._brick(space)

    def _brick(self, space: Space) -> Brick:
        """A cylinder: the section is extended over the axis, so that no surface is at the axis."""
        lower, upper = np.array(self.lower, dtype=float), np.array(self.upper, dtype=float)
        if self._at_axis(space):
            lower[0] = -upper[0]
        return Brick(lower, upper)

    def ends(self, space: Space) -> tuple[str, ...]:
        return tuple(face for face in space.faces if not (self._at_axis(space) and face == "r_min"))

    def _at_axis(self, space: Space) -> bool:
        return space.radial and self.lower[0] == 0

    def _shell(self, space: Space, thickness: float, open_ends: Sequence[str]) -> Solid:
        faces = [[f"{axis}_{side}" not in open_ends for axis in space.axes] for side in ("min", "max")]
        closed = np.array(faces)
        if self._at_axis(space):
            closed[0, 0] = closed[1, 0]
        return BrickShell(self._brick(space), thickness, closed)

    def _bounds(self, space: Space) -> tuple[list[float], list[float]]:
        return self.lower, self.upper

    def _contains(self, points: np.ndarray, space: Space, tolerance: float) -> np.ndarray:
        inside = np.ones(len(points), dtype=bool)
        for axis, (low, high) in enumerate(zip(self.lower, self.upper, strict=True)):
            inside &= points[:, axis] >= low - tolerance
            inside &= points[:, axis] <= high + tolerance
        return inside

    def _size(self, space: Space) -> float:
        return math.prod(high - low for low, high in zip(self.lower, self.upper, strict=True))

    def _volume(self, space: Space) -> float:
        # π (r₁² − r₀²) h = 2π · mean radius · area, without the cancellation of the squares of a thin ring.
        return self._size(space) * (math.pi * (self.lower[0] + self.upper[0]) if space.radial else 1.0)

    def _volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        return Box(kind="box", lower=lower.tolist(), upper=upper.tolist())._volume(space)
