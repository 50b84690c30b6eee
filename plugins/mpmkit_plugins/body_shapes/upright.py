"""A body of circular cross-section that stands on the middle of its bottom disc."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence

import numpy as np

from mpmkit.contracts import BodyShape, Space, quantity
from mpmkit.geometry import (
    Jointed,
    Revolved,
    Section,
    Solid,
    part_of_revolved,
    trapezium,
    trapezium_plates,
    trapezium_shell,
)

from .lengths import off_axis, squared_distance, wrong_length

Loop = list[tuple[float, float]]


class Upright(BodyShape):
    """R(z) = R_b + (R_t − R_b)(z − z_b)/h along the last axis; what frustum and cylinder share.

    Volume π h (R_b² + R_b R_t + R_t²)/3; in plane strain (R_b + R_t) h · 1 m.
    """

    height: float = quantity("m", "height along the last axis", gt=0)
    base: list[float] | None = quantity(
        "m", "centre of the bottom disc; default: the origin", default=None, min_length=2, max_length=3
    )

    @abstractmethod
    def _radii(self) -> tuple[float, float]:
        """Radius at the bottom and at the top, m."""

    def _foot(self, space: Space) -> list[float]:
        return [0.0] * space.dim if self.base is None else self.base

    turned = True

    def middle(self, space: Space) -> tuple[float, float] | None:
        if space.dim == 2:
            return None
        x, y = (self.base or [0.0, 0.0])[:2]
        return x, y

    def problem(self, space: Space) -> str | None:
        given = (self, "base", self._foot(space), space)
        return wrong_length(*given) or off_axis(*given)

    def solid(self, space: Space) -> Solid:
        return self._turned(trapezium(*self._radii(), self.height), space)

    def ends(self, space: Space) -> tuple[str, ...]:
        """An end of a full cone is a point, and cannot be open."""
        return tuple(
            name for name, radius in zip(("bottom", "top"), self._radii(), strict=True) if radius > 0
        )

    def ends_left_open(self, space: Space) -> tuple[str, ...]:
        """A mould has neither a floor nor a lid."""
        return self.ends(space)

    def shell(self, space: Space, thickness: float, open_ends: Sequence[str]) -> Solid:
        shell = *self._radii(), self.height, thickness, open_ends
        plates = [self._turned(loops, space) for loops in trapezium_plates(*shell)]
        return Jointed(self._turned(trapezium_shell(*shell), space), tuple(plates))

    def _turned(self, loops: list[Loop], space: Space) -> Solid:
        """The section inside loops around the axis of the body; in 3-D, its body of revolution."""
        *middle, foot = self._foot(space)
        if space.dim == 3:
            return Revolved(Section.of(loops, (0.0, foot)), np.array(middle, dtype=float))
        return Section.of(loops, (middle[0], foot))

    def bounds(self, space: Space) -> tuple[np.ndarray, np.ndarray]:
        *middle, bottom = self._foot(space)
        radius = max(self._radii())
        lower = [0.0] if space.radial else [x - radius for x in middle]
        upper = [*(x + radius for x in middle), bottom + self.height]
        return np.array([*lower, bottom]), np.array(upper)

    def signed_distance(self, x: np.ndarray, space: Space) -> np.ndarray:
        return self.solid(space).distance(x)[0]

    def within(self, x: np.ndarray, space: Space, tolerance: float) -> np.ndarray:
        *middle, bottom = self._foot(space)
        level = x[:, -1] - bottom
        inside = (level >= -tolerance) & (level <= self.height + tolerance)
        radius = self._radius(level) + tolerance
        return inside & (squared_distance(x, middle) <= radius * radius)

    def _radius(self, level: np.ndarray) -> np.ndarray:
        """Radius, m, at heights above the bottom, m."""
        bottom, top = self._radii()
        # Above the tip of a full cone, within the tolerance, the radius would be negative.
        return np.maximum(bottom + (top - bottom) / self.height * level, 0.0)

    def size(self, space: Space) -> float:
        if space.dim == 3:
            return self.volume(space)
        width = sum(self._radii())
        return width * self.height / (2 if space.radial else 1)

    def volume(self, space: Space) -> float:
        if space.dim == 2 and not space.radial:
            return self.size(space)
        bottom, top = self._radii()
        return math.pi * self.height / 3 * (bottom**2 + bottom * top + top**2)

    def volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        *middle, foot = self._foot(space)
        bottom, top = self._radii()

        def heights(radius: float) -> list[float]:
            return [] if top == bottom else [foot + (radius - bottom) / (top - bottom) * self.height]

        return part_of_revolved(lambda z: self._radius(z - foot), heights, middle, lower, upper, space)
