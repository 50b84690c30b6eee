"""A region between straight edges; in 3-D, the prism over it."""

from __future__ import annotations

import math
from itertools import combinations, pairwise

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import BodyShape, Space, hookimpl, quantity
from mpmkit.geometry import Extruded, Section, Solid

Corners = list[tuple[float, float]]
_FLAT = 1e-9
"""Area, relative to that of the box around it, below which a polygon has no inside."""


class Polygon(BodyShape):
    """The region inside a closed line of straight edges, in the plane of the first and the last axis.

    In 3-D it is a prism, V = A (y₁ − y₀); in plane strain 1 m thick; in an axisymmetric scene the corners are
    (r, z), and V = 2π A r̄ with r̄ the radius of the centroid (Pappus).
    """

    name = "polygon"
    api_version = 2
    citation = "none: elementary geometry"

    corners: list[list[float]] = quantity(
        "m",
        "its corners in order, each a pair of coordinates along the first and the last axis, such as "
        "[[0, 0], [1, 0], [0, 1]]",
        min_length=3,
    )
    y: list[float] | None = quantity(
        "m", "where the prism begins and ends along y; only in 3-D", default=None, min_length=2, max_length=2
    )

    @model_validator(mode="after")
    def _has_an_inside(self) -> Polygon:
        for corner in self.corners:
            if len(corner) != 2:
                raise ValueError(f"corners has {corner}; each corner must be a pair of numbers")
        size = np.ptp(np.array(self.corners), axis=0).prod()
        if abs(_area(self._loop)) <= _FLAT * size:
            raise ValueError(f"corners is {self.corners}, which encloses no area")
        edges = list(zip(self._loop, self._loop[1:] + self._loop[:1], strict=True))
        for (i, first), (j, second) in combinations(enumerate(edges), 2):
            if j - i not in (1, len(edges) - 1) and _cross(*first, *second):
                raise ValueError(
                    f"corners is {self.corners}, but the edges from {list(first[0])} to {list(first[1])} and "
                    f"from {list(second[0])} to {list(second[1])} meet; edges may meet only at corners"
                )
        if self.y is not None and self.y[0] >= self.y[1]:
            raise ValueError(f"y is {self.y}; the first number must be below the second")
        return self

    def inner_edges(self, inside: bool) -> str | None:
        turns = [_turn(a, b, c) for a, b, c in zip(*(self._from(k) for k in range(3)), strict=True)]
        convex = min(turns) >= 0 or max(turns) <= 0
        return None if convex else "a polygon with a corner that points inwards"

    @property
    def _loop(self) -> Corners:
        return [(a, b) for a, b in self.corners]

    def _from(self, k: int) -> Corners:
        return self._loop[k:] + self._loop[:k]

    def middle(self, space: Space) -> tuple[float, float] | None:
        """None if the polygon is not symmetric about the vertical through its middle."""
        if space.dim == 2:
            return None
        x = [a for a, _ in self.corners]
        across = min(x) + max(x)
        mirrored = sorted((across - a, b) for a, b in self.corners)
        near = self.tolerance * (max(x) - min(x))
        same = np.abs(np.array(mirrored) - sorted(self._loop)).max() <= near
        return (across / 2, sum(self.y or ()) / 2) if same else None

    def problem(self, space: Space) -> str | None:
        if (space.dim == 3) != (self.y is not None):
            needs = "needs y, where it begins and ends" if space.dim == 3 else "has no y: leave it out"
            return f"the polygon's y is {self.y}, but in the space {space.name} it {needs}"
        if space.radial and min(r for r, _ in self.corners) < 0:
            return (
                f"the polygon's corners are {self.corners}, but in the space {space.name} their r must be "
                "at least 0"
            )
        return None

    def solid(self, space: Space) -> Solid:
        section = self._section(space)
        return section if self.y is None else Extruded(section, *self.y)

    def _section(self, space: Space) -> Section:
        """An edge on the axis of an axisymmetric scene is no surface: the mirror image continues there."""
        start = np.array(self._from(0) if _area(self._loop) > 0 else self._loop[::-1])
        end = np.roll(start, -1, axis=0)
        if space.radial and (on_axis := (start[:, 0] == 0) & (end[:, 0] == 0)).any():
            start, end, mirror = start[~on_axis], end[~on_axis], np.array([-1.0, 1.0])
            start, end = np.concatenate([start, end * mirror]), np.concatenate([end, start * mirror])
        return Section(start, end)

    def bounds(self, space: Space) -> tuple[np.ndarray, np.ndarray]:
        lower, upper = np.min(self.corners, axis=0), np.max(self.corners, axis=0)
        if self.y is None:
            return lower, upper
        return np.insert(lower, 1, self.y[0]), np.insert(upper, 1, self.y[1])

    def signed_distance(self, x: np.ndarray, space: Space) -> np.ndarray:
        return self.solid(space).distance(x)[0]

    def size(self, space: Space) -> float:
        return self._thickness() * abs(_area(self._loop))

    def volume(self, space: Space) -> float:
        return self._thickness() * _volume(self._loop, space)

    def volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        part = self._loop
        for axis in (0, 1):
            part = _cut(_cut(part, axis, lower[-axis], 1.0), axis, upper[-axis], -1.0)
        return (1.0 if self.y is None else float(upper[1] - lower[1])) * _volume(part, space)

    def _thickness(self) -> float:
        return 1.0 if self.y is None else self.y[1] - self.y[0]


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    """Twice the area of a triangle; above 0 if its corners go round to the left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _cross(
    a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], d: tuple[float, float]
) -> bool:
    """Whether the edges ab and cd share a point."""
    sides = [_turn(a, b, c), _turn(a, b, d), _turn(c, d, a), _turn(c, d, b)]
    if not any(sides):  # on one line
        axis = 0 if a[0] != b[0] else 1
        low, high = sorted((a[axis], b[axis]))
        return low <= max(c[axis], d[axis]) and min(c[axis], d[axis]) <= high
    return sides[0] * sides[1] <= 0 and sides[2] * sides[3] <= 0


def _area(loop: Corners) -> float:
    """Above 0 if the corners go round to the left."""
    return sum(a * d - c * b for (a, b), (c, d) in pairwise([*loop, *loop[:1]])) / 2


def _volume(loop: Corners, space: Space) -> float:
    """∫ dA, or ∫ 2π r dA = (π/3) Σ (r + r′) (r z′ − r′ z), of a region, m² or m³."""
    if not space.radial:
        return abs(_area(loop))
    return (
        math.pi / 3 * abs(sum((a + c) * (a * d - c * b) for (a, b), (c, d) in pairwise([*loop, *loop[:1]])))
    )


def _cut(loop: Corners, axis: int, at: float, side: float) -> Corners:
    """The part of a region on one side of a line across an axis (Sutherland & Hodgman 1974)."""
    found: Corners = []
    for a, b in zip(loop, loop[1:] + loop[:1], strict=True):
        from_a, from_b = side * (a[axis] - at), side * (b[axis] - at)
        if from_a >= 0:
            found.append(a)
        if from_a * from_b < 0:
            part = from_a / (from_a - from_b)
            found.append((a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])))
    return found


@hookimpl
def mpmkit_body_shapes() -> list[type[BodyShape]]:
    return [Polygon]
