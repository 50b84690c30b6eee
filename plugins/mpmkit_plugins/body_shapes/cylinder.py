"""The upright cylinder."""

from __future__ import annotations

from mpmkit.contracts import BodyShape, hookimpl, quantity

from .upright import Upright


class Cylinder(Upright):
    """Upright cylinder, V = π R² h; a rectangle of width 2 R in plane strain.

    In an axisymmetric scene its base is [0, z].
    """

    name = "cylinder"
    api_version = 2
    citation = "none: elementary geometry"

    radius: float = quantity("m", "radius", gt=0)

    def _radii(self) -> tuple[float, float]:
        return self.radius, self.radius


@hookimpl
def mpmkit_body_shapes() -> list[type[BodyShape]]:
    return [Cylinder]
