"""The box along the axes of the grid; a ring in an axisymmetric scene."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import BodyShape, Space, hookimpl, quantity
from mpmkit.geometry import Brick, BrickShell, Solid

from .lengths import wrong_length


class Box(BodyShape):
    """Box between two corners, V = Π (u_a − l_a), 1 m thick in plane strain.

    In an axisymmetric scene the corners are (r, z), the box is a ring, V = π (r₁² − r₀²) h, and r₀ ≥ 0.
    """

    name = "box"
    api_version = 2
    citation = "none: elementary geometry"

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

    def middle(self, space: Space) -> tuple[float, float] | None:
        if space.dim == 2:
            return None
        x, y, _ = ((low + high) / 2 for low, high in zip(self.lower, self.upper, strict=True))
        return x, y

    def problem(self, space: Space) -> str | None:
        if problem := wrong_length(self, "lower", self.lower, space):
            return problem
        if space.radial and self.lower[0] < 0:
            return f"the box's lower is {self.lower}, but in the space {space.name} its r must be at least 0"
        return None

    def solid(self, space: Space) -> Solid:
        return self._brick(space)

    def _brick(self, space: Space) -> Brick:
        """A cylinder: the section is extended over the axis, so that no surface is at the axis."""
        lower, upper = np.array(self.lower, dtype=float), np.array(self.upper, dtype=float)
        if self._at_axis(space):
            lower[0] = -upper[0]
        return Brick(lower, upper)

    shell_needs_an_end = True

    def ends(self, space: Space) -> tuple[str, ...]:
        return tuple(face for face in space.faces if not (self._at_axis(space) and face == "r_min"))

    def _at_axis(self, space: Space) -> bool:
        return space.radial and self.lower[0] == 0

    def shell(self, space: Space, thickness: float, open_ends: Sequence[str]) -> Solid:
        faces = [[f"{axis}_{side}" not in open_ends for axis in space.axes] for side in ("min", "max")]
        closed = np.array(faces)
        if self._at_axis(space):
            closed[0, 0] = closed[1, 0]
        return BrickShell(self._brick(space), thickness, closed)

    def bounds(self, space: Space) -> tuple[np.ndarray, np.ndarray]:
        return np.array(self.lower, dtype=float), np.array(self.upper, dtype=float)

    def signed_distance(self, x: np.ndarray, space: Space) -> np.ndarray:
        return self._brick(space).distance(x)[0]

    def within(self, x: np.ndarray, space: Space, tolerance: float) -> np.ndarray:
        inside = np.ones(len(x), dtype=bool)
        for axis, (low, high) in enumerate(zip(self.lower, self.upper, strict=True)):
            inside &= x[:, axis] >= low - tolerance
            inside &= x[:, axis] <= high + tolerance
        return inside

    def size(self, space: Space) -> float:
        return math.prod(high - low for low, high in zip(self.lower, self.upper, strict=True))

    def volume(self, space: Space) -> float:
        # π (r₁² − r₀²) h = 2π · mean radius · area, without the cancellation of the squares of a thin ring.
        return self.size(space) * (math.pi * (self.lower[0] + self.upper[0]) if space.radial else 1.0)

    def volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        return Box(lower=lower.tolist(), upper=upper.tolist()).volume(space)


@hookimpl
def mpmkit_body_shapes() -> list[type[BodyShape]]:
    return [Box]
