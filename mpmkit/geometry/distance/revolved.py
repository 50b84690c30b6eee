"""The distance of a body of revolution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...contracts.solid import Found, Solid
from .ball import unit

_AROUND = 64
"""Corners of the polygon around a circle; it is a thousandth wider."""


@dataclass(frozen=True)
class Revolved(Solid):
    """A section, turned about the vertical through ``middle``, m, (2,), in 3-D.

    It is symmetric about the axis, or has no part behind it.

    The point of the surface nearest to a point is in its plane with the axis: φ is that of the section.
    """

    section: Solid
    middle: np.ndarray

    def distance(self, x: np.ndarray) -> Found:
        outwards, radius = unit(x[:, :2] - self.middle)
        distance, gradient = self.section.distance(np.column_stack([radius, x[:, 2]]))
        return distance, np.column_stack([gradient[:, :1] * outwards, gradient[:, 1]])

    def parts(self, radial: bool) -> tuple[Solid, ...]:
        return tuple(Revolved(part, self.middle) for part in self.section.parts(radial=True))

    def outsides(self, radial: bool) -> tuple[Solid, ...]:
        return tuple(Revolved(part, self.middle) for part in self.section.outsides(radial=True))

    def hull(self) -> tuple[np.ndarray, float] | None:
        found = self.section.hull()
        if found is None:
            return None
        corners, _ = found
        angle = 2 * np.pi * np.arange(_AROUND) / _AROUND
        circle = np.column_stack([np.cos(angle), np.sin(angle)]) / np.cos(np.pi / _AROUND)
        around = [
            np.column_stack([self.middle + radius * circle, np.full(_AROUND, z)])
            for radius, z in corners
            if radius >= 0
        ]
        return np.concatenate(around), 0.0
