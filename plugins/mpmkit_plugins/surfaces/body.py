"""The surface of a body, from inside or from outside, or a shell around it."""

from typing import Any, Literal

import numpy as np
from pydantic import Field

from mpmkit.contracts import AnyShape, Space, Surface, hookimpl, quantity
from mpmkit.geometry import Inverted, MovingSolid, Solid

from .rigid import LARGEST, RigidSurface


class BodySurface(RigidSurface):
    """The surface of any shape that a body of material may have; d is the distance to it.

    From inside, the wall is around the shape and fills all the rest of space, or is a shell as thick as
    ``thickness`` whose inner surface is that of the shape, with room for material on both sides. From
    outside, the shape is an obstacle.
    """

    name = "body"
    api_version = 2
    citation = "Osher & Fedkiw, Level Set Methods and Dynamic Implicit Surfaces (2003), chapter 2"

    shape: AnyShape = Field(description="a shape, with the same keys as that of a body")
    side: Literal["inside", "outside"] = Field(
        description="where the material is: inside of the shape, or outside of it"
    )
    thickness: float | None = quantity(
        "m",
        "thickness of a shell, outwards; only inside, and default: the wall fills all the rest",
        default=None,
        gt=0,
    )
    open: list[str] | None = Field(
        default=None,
        description="ends that a shell leaves open: 'bottom' and 'top' of a cylinder or frustum, faces of a "
        "box such as 'z_max'; default: both ends of a cylinder or frustum, no face of a box",
    )

    def problem(self, space: Space) -> str | None:
        if reason := super().problem(space):
            return reason
        if reason := self.shape.problem(space):
            return reason
        if self.side == "outside" and self.thickness is not None:
            return (
                f"thickness is {self.thickness:g} m, but with side 'outside' the wall is solid: leave it out"
            )
        if self.open is not None:
            if self.thickness is None:
                return f"open is {self.open}, but only a shell has ends that can be open: give its thickness"
            if reason := self._cannot_open(space):
                return reason
        if self.thickness is not None:
            hull = self._shell(space, self.thickness).hull()
            if hull is not None and np.abs(hull[0]).max() > LARGEST:
                return f"the {self.shape.name} is so flat that a shell of it has no end"
        return None

    def _cannot_open(self, space: Space) -> str | None:
        ends, named = self.shape.ends(space), self.open or []
        allowed = ", ".join(f"'{end}'" for end in ends)
        for end in named:
            if not ends:
                return (
                    f"open is {self.open}, but a {self.shape.name} has no ends that can be open: leave it out"
                )
            if end not in ends:
                return f"open is {self.open}; of this {self.shape.name} {allowed} can be open"
        if set(named) == set(ends) and self.shape.shell_needs_an_end:
            return f"open is {self.open}, which leaves no wall: one face must stay closed"
        return None

    def cautions(self, case: Any) -> list[str]:
        """Of faces that meet in an inner edge a node knows the nearest, unless the shape has parts."""
        what = self.shape.inner_edges(self.side == "inside")
        if what is None:
            return []
        return [
            f"walls.{name} is {what}, and contact '{wall.contact.name}' lets material slide in its inner "
            "edges: a node knows only one of the faces there, so that material may sink into the edge; "
            "a separate wall for each face holds it"
            for name, wall in case.walls.items()
            if wall.surface == self and wall.contact.parity == "mirror"
        ]

    def placed(self, space: Space) -> MovingSolid:
        if self.side == "outside":
            obstacle = self.shape.solid(space)
            return self.moving(obstacle, space, obstacle.extent())
        if self.thickness is None:
            return self.moving(Inverted(self.shape.solid(space)), space)
        return self.moving(self._shell(space, self.thickness), space, self.thickness)

    def _shell(self, space: Space, thickness: float) -> Solid:
        open_ends = self.shape.ends_left_open(space) if self.open is None else self.open
        return self.shape.shell(space, thickness, open_ends)


@hookimpl
def mpmkit_surfaces() -> list[type[Surface]]:
    return [BodySurface]
