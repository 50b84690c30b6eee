"""A body given by a closed surface mesh in a file."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field

from ..contracts.base import quantity
from ..errors import CaseError
from ..output.content_names import name_by_content
from ..spaces import Space
from .base import Shape
from .crossing import crossing
from .distance import Solid
from .distance.surface_mesh import SurfaceMesh
from .mesh_file import as_ply, read_surface, require_file


class Mesh(Shape):
    """Solid inside a closed surface of triangles or quadrilaterals, x = scale · x_file + translate.

    Only in 3-D; needs libigl and trimesh. Normals that point inwards are turned; a shell within another is a
    cavity. Shells that overlap and surfaces that cross themselves are refused, and so is a file of more than
    1 GiB.
    """

    kind: Literal["mesh"]
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
        return as_ply(*read_surface(str(Path(self.file).absolute()), self.file))

    def content_name(self, field: str) -> str:
        return self._loaded()[1]

    def _surface(self) -> Any:
        return self._loaded()[0]

    def _loaded(self) -> tuple[Any, str]:
        path = Path(self.file).absolute()
        changed = require_file(str(path), self.file).st_mtime_ns
        shift = (0.0, 0.0, 0.0) if self.translate is None else tuple(self.translate)
        # The time of change is part of the key, so that a process that rewrites a mesh reads the new one.
        return _load(str(path), changed, self.file, self.scale, shift)

    def _problem(self, space: Space) -> str | None:
        if space.dim != 3:
            return (
                f"the mesh's file is {self.file}, but the space is {space.name}: a mesh is allowed only in 3d"
            )
        try:
            self._surface()
        except CaseError as error:
            return str(error)
        return None

    def _solid(self, space: Space) -> Solid:
        surface = self._surface()
        return SurfaceMesh(np.ascontiguousarray(surface.vertices), np.ascontiguousarray(surface.faces))

    def _bounds(self, space: Space) -> tuple[list[float], list[float]]:
        lower, upper = self._surface().bounds.tolist()
        return lower, upper

    def _contains(self, points: np.ndarray, space: Space, tolerance: float) -> np.ndarray:
        import igl

        surface = self._surface()
        # From the middle of the surface, because the winding number is computed in single precision: it is
        # then in doubt only within about 1e-7 of the extent from the surface, where the distance decides.
        middle = surface.bounds.mean(axis=0)
        vertices, faces = surface.vertices - middle, np.asarray(surface.faces)
        points = points - middle
        inside = igl.fast_winding_number(vertices, faces, points) > 0.5
        unsigned = igl.SignedDistanceType.SIGNED_DISTANCE_TYPE_UNSIGNED
        distance = igl.signed_distance(points, vertices, faces, unsigned, 0, tolerance)[0]
        return inside | (distance <= tolerance)  # farther away the distance is NaN

    def _size(self, space: Space) -> float:
        return self._volume(space)

    def _volume(self, space: Space) -> float:
        return float(self._surface().volume)

    def _volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        surface = self._surface()
        part = np.asarray(surface.vertices), np.asarray(surface.faces)
        for axis in (1, 2):
            part = _beyond(part, axis, lower[axis], 1)
            part = _beyond(part, axis, upper[axis], -1)
        return _volume_beyond(part, lower[0]) - _volume_beyond(part, upper[0])


def _beyond(
    surface: tuple[np.ndarray, np.ndarray], axis: int, place: float, sign: int
) -> tuple[np.ndarray, np.ndarray]:
    """Corners and triangles of the part of a surface above a plane (sign 1) or below it (-1), left open."""
    from trimesh.intersections import slice_faces_plane

    vertices, faces = surface
    if len(faces) == 0:
        return surface
    normal = np.eye(3)[axis]
    return slice_faces_plane(vertices, faces, sign * normal, place * normal)[:2]


def _volume_beyond(surface: tuple[np.ndarray, np.ndarray], x: float) -> float:
    """∮ (X − x) n_X dA over the part of a surface with X ≥ x, m³.

    By Gauss's theorem this is the volume of the solid beyond x, although the cuts are open: the integrand is
    zero on a cut at x and on cuts along X.
    """
    vertices, faces = _beyond(surface, 0, x, 1)
    a, b, c = vertices[faces.T]
    area = np.cross(b - a, c - a)[:, 0] / 2
    return float(area @ ((a + b + c)[:, 0] / 3 - x))


@lru_cache(maxsize=8)
def _load(path: str, changed: int, shown: str, scale: float, shift: tuple[float, ...]) -> tuple[Any, str]:
    """The surface as a ``trimesh.Trimesh``, in metres, normals outwards, and the name from the file's
    content.

    ``shown`` names it in errors.
    """
    try:
        import igl  # noqa: F401
        import trimesh
    except ImportError:
        raise CaseError(
            f"the mesh's file is {shown}, but bodies given as a mesh need libigl and trimesh: "
            "pip install libigl trimesh, or pip install '.[mesh]' in a clone of mpmkit"
        ) from None
    vertices, faces = read_surface(path, shown)
    name = name_by_content(as_ply(vertices, faces), ".ply")
    surface = trimesh.Trimesh(vertices, faces, process=False)
    # STL repeats each corner in each of its triangles; triangles that collapse by merging are removed.
    surface.merge_vertices(merge_tex=True, merge_norm=True)
    faces = np.asarray(surface.faces)
    degenerate = (faces == np.roll(faces, 1, axis=1)).any(axis=1)
    surface.update_faces(~degenerate)
    if len(surface.faces) == 0 or not surface.is_watertight:
        raise CaseError(f"the mesh's file is {shown}, but {_why_not_watertight(np.asarray(surface.faces))}")
    vertices = np.asarray(surface.vertices) * scale + shift
    closed = trimesh.Trimesh(vertices, _outward(vertices, np.asarray(surface.faces)), process=False)
    place = crossing(np.asarray(closed.vertices), np.asarray(closed.faces))
    if place is not None:
        raise CaseError(
            f"the mesh's file is {shown}, but its surface crosses itself, or shells of it overlap, near "
            f"({', '.join(f'{x:.4g}' for x in place)}) m, so that it does not say what is inside; they must "
            "be united (a boolean union) in the program that wrote the file"
        )
    if not _volume(closed.vertices, closed.faces) > 0:
        raise CaseError(f"the mesh's file is {shown}, but its surface encloses no volume")
    return closed, name


def _volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Volume, m³, that a closed surface encloses; negative if its normals point inwards."""
    a, b, c = (vertices - vertices.mean(axis=0))[faces.T]
    with np.errstate(all="ignore"):  # an overflow gives a volume that is not finite
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def _just_inside(vertices: np.ndarray, faces: np.ndarray, inward: bool) -> np.ndarray:
    """A point, m, (3,), beneath the largest triangle of a shell whose normals may point inwards."""
    a, b, c = vertices[faces.T]
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1)
    largest = int(np.argmax(area))
    depth = 1e-5 * np.ptp(vertices[faces], axis=(0, 1)).max() * (1 if inward else -1)
    return (a + b + c)[largest] / 3 + depth * normal[largest] / max(area[largest], 1e-300)


def _outward(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The faces (t, 3) of a closed surface, turned so that their normals point out of the solid.

    A shell in an odd number of others is the wall of a cavity and encloses a negative volume.
    """
    import igl

    faces, shells = igl.bfs_orient(faces)  # neighbours now agree
    count = int(shells.max()) + 1
    for shell in range(count):
        own = shells == shell
        inward = _volume(vertices, faces[own]) < 0
        # Each surrounding shell adds ±1, for any orientation: the sum is odd if their number is odd. A corner
        # cannot be used, because it may lie on another shell that this one touches.
        depth = (
            igl.winding_number(vertices, faces[~own], _just_inside(vertices, faces[own], inward))
            if count > 1
            else 0
        )
        if inward != (abs(depth) % 2 > 0.5):
            faces[own] = faces[own][:, ::-1]
    return faces


def _why_not_watertight(faces: np.ndarray) -> str:
    """An edge with one triangle is at a hole; at an edge with more than two, shells touch."""
    edges = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    if (count == 2).all() or (count == 1).any():
        return "its surface is not closed: each edge must belong to exactly two triangles"
    return (
        f"{np.count_nonzero(count > 2)} edges belong to more than two triangles, so that its surface is not "
        "closed: shells of it touch there, or one is in the file twice; they must be united (a boolean "
        "union) in the program that wrote it"
    )
