"""A plane."""

import numpy as np

from mpmkit.contracts import Space, Surface, hookimpl, quantity
from mpmkit.geometry import HalfSpace, MovingSolid, Rotation

from .rigid import RigidSurface


class Plane(RigidSurface):
    """d = (x - point)·n: material may be on the side to which the normal points."""

    name = "plane"
    api_version = 2
    citation = "Osher & Fedkiw, Level Set Methods and Dynamic Implicit Surfaces (2003), chapter 2"

    point: list[float] = quantity("m", "a point of the plane", min_length=2, max_length=3)
    normal: list[float] = quantity(
        "1", "direction into the material, of any length", min_length=2, max_length=3
    )

    def problem(self, space: Space) -> str | None:
        for field in ("point", "normal"):
            vector = getattr(self, field)
            if len(vector) != space.dim:
                return (
                    f"{field} is {vector}, but the space {space.name} needs {space.dim} numbers "
                    f"({', '.join(space.axes)})"
                )
        if not any(self.normal):
            return (
                f"normal is {self.normal}; it must be a direction, such as {[0.0] * (space.dim - 1) + [1.0]}"
            )
        if isinstance(self.motion, Rotation):
            return (
                "the motion's kind is 'rotation', but a plane is infinite, and so would be its speed; "
                "use a body, such as a box"
            )
        return super().problem(space)

    def placed(self, space: Space) -> MovingSolid:
        normal = np.array(self.normal) / np.abs(self.normal).max()  # whose square may be no number
        normal /= np.linalg.norm(normal)
        return self.moving(HalfSpace(np.array(self.point), normal), space)


@hookimpl
def mpmkit_surfaces() -> list[type[Surface]]:
    return [Plane]
