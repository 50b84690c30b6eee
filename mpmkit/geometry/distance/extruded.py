"""The distance of a prism: a section between two planes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...contracts.solid import Found, HalfSpace, Solid
from .ball import unit
from .section import Section


@dataclass(frozen=True)
class Extruded(Solid):
    """A section in the plane of x and z, in 3-D between y = ``near`` and y = ``far``, m.

    Outside, φ is the length of the way to the section and the way to the planes together; inside, the shorter
    of the two counts.
    """

    section: Section
    near: float
    far: float

    def distance(self, x: np.ndarray) -> Found:
        of_section, gradient = self.section.distance(x[:, ::2])
        offset = x[:, 1] - (self.near + self.far) / 2
        of_planes = np.abs(offset) - (self.far - self.near) / 2
        sides = np.column_stack([gradient[:, 0], np.zeros(len(x)), gradient[:, 1]])
        planes = np.zeros_like(sides)
        planes[:, 1] = np.where(offset < 0, -1.0, 1.0)
        outwards, outside = unit(
            np.maximum(of_section, 0.0)[:, None] * sides + np.maximum(of_planes, 0.0)[:, None] * planes
        )
        depth = np.maximum(of_section, of_planes)
        nearest = np.where((of_section >= of_planes)[:, None], sides, planes)
        is_outside = depth > 0
        return np.where(is_outside, outside, depth), np.where(is_outside[:, None], outwards, nearest)

    def outsides(self, radial: bool) -> tuple[Solid, ...]:
        """The outsides of the section, and a half-space for each plane."""
        across = np.array([0.0, 1.0, 0.0])
        planes = (HalfSpace(self.near * across, across), HalfSpace(self.far * across, -across))
        return (*(_Endless(part) for part in self.section.outsides(radial)), *planes)

    def hull(self) -> tuple[np.ndarray, float]:
        corners, radius = self.section.hull()
        ends = [np.insert(corners, 1, y, axis=1) for y in (self.near, self.far)]
        return np.concatenate(ends), radius


@dataclass(frozen=True)
class _Endless(Solid):
    """A plane solid that goes on along y for ever."""

    plane: Solid

    def distance(self, x: np.ndarray) -> Found:
        distance, gradient = self.plane.distance(np.ascontiguousarray(x[:, ::2]))
        return distance, np.column_stack([gradient[:, 0], np.zeros(len(x)), gradient[:, 1]])

    def hull(self) -> None:
        return None
