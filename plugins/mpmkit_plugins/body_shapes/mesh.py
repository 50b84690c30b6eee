"""A body given by a closed surface mesh in a file."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import Field

from mpmkit.contracts import BodyShape, Space, hookimpl, quantity
from mpmkit.geometry import (
    Solid,
    SurfaceMesh,
    copy_of_file,
    inside_surface,
    problem_of_file,
    surface_in_file,
    volume_in_surface,
)


class Mesh(BodyShape):
    """Solid inside a closed surface of triangles or quadrilaterals, x = scale · x_file + translate.

    Only in 3-D; needs libigl and trimesh. Normals that point inwards are turned; a shell within another is a
    cavity. Shells that overlap and surfaces that cross themselves are refused, and so is a file of more than
    1 GiB.
    """

    name = "mesh"
    api_version = 2
    citation = "Bærentzen & Aanæs, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243-253"

    file: str = Field(
        description="path to a closed surface mesh (STL, OBJ, PLY, or what meshio reads: VTU, ...) of at "
        "most 1 GiB; a relative one starts from the folder of the case file"
    )
    scale: float = quantity("1", "factor from the file's unit to metres, 0.001 for mm", default=1.0, gt=0)
    translate: list[float] | None = quantity(
        "m", "shift after scaling; default: none", default=None, min_length=3, max_length=3
    )

    tolerance = 1e-6  # the file may hold its corners in single precision
    files = ("file",)

    def content(self, field: str) -> bytes:
        return copy_of_file(self.file)

    def content_name(self, field: str) -> str:
        return self._loaded()[1]

    def _loaded(self) -> tuple[Any, str]:
        return surface_in_file(self.file, self.scale, self.translate or (0.0, 0.0, 0.0))

    @property
    def _surface(self) -> Any:
        return self._loaded()[0]

    def problem(self, space: Space) -> str | None:
        if space.dim != 3:
            return (
                f"the mesh's file is {self.file}, but the space is {space.name}: a mesh is allowed only in 3d"
            )
        return problem_of_file(self.file, self.scale, self.translate or (0.0, 0.0, 0.0))

    def bounds(self, space: Space) -> tuple[np.ndarray, np.ndarray]:
        lower, upper = self._surface.bounds
        return np.array(lower), np.array(upper)

    def signed_distance(self, x: np.ndarray, space: Space) -> np.ndarray:
        return self.solid(space).distance(x)[0]

    def within(self, x: np.ndarray, space: Space, tolerance: float) -> np.ndarray:
        return inside_surface(self._surface, x, tolerance)

    def solid(self, space: Space) -> Solid:
        surface = self._surface
        return SurfaceMesh(np.ascontiguousarray(surface.vertices), np.ascontiguousarray(surface.faces))

    def inner_edges(self, inside: bool) -> str | None:
        return "a mesh" if inside else None

    def size(self, space: Space) -> float:
        return self.volume(space)

    def volume(self, space: Space) -> float:
        return float(self._surface.volume)

    def volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        return volume_in_surface(self._surface, lower, upper)


@hookimpl
def mpmkit_body_shapes() -> list[type[BodyShape]]:
    return [Mesh]
