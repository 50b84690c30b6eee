"""The upright cylinder."""

from __future__ import annotations

from typing import Literal

from ..contracts.base import quantity
from .upright import Upright


class Cylinder(Upright):
    """Upright cylinder, V = π R² h; a rectangle of width 2 R in plane strain.

    In an axisymmetric scene its base is [0, z].
    """

    kind: Literal["cylinder"]
    radius: float = quantity("m", "radius", gt=0)

    def _radii(self) -> tuple[float, float]:
        return self.radius, self.radius
