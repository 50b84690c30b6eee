"""A closed surface of triangles in a file: reading it, what is inside, and how much."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CaseError
from ..output.content_names import name_by_content
from .crossing import crossing
from .mesh_file import as_ply, read_surface, require_file


def surface_in_file(file: str, scale: float, shift: Sequence[float]) -> tuple[Any, str]:
    """The surface as a ``trimesh.Trimesh``, x = scale · x_file + shift, m, normals outwards, and the name of
    a copy of the file, made from its content.

    Raises:
        CaseError: libigl or trimesh is missing, or the file cannot be used; one sentence says why.
    """
    path = Path(file).absolute()
    changed = require_file(str(path), file).st_mtime_ns
    # The time of change is part of the key, so that a process that rewrites a mesh reads the new one.
    return _load(str(path), changed, file, scale, tuple(shift))


def problem_of_file(file: str, scale: float, shift: Sequence[float]) -> str | None:
    """The sentence about a file of a surface that cannot be used, or None."""
    try:
        surface_in_file(file, scale, shift)
    except CaseError as error:
        return str(error)
    return None


def copy_of_file(file: str) -> bytes:
    """The surface in a file as the content of a PLY file, which needs no other file.

    Raises:
        CaseError: the file cannot be read.
    """
    return as_ply(*read_surface(str(Path(file).absolute()), file))


def inside_surface(surface: Any, points: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether points, m, (n, 3), are inside a surface or at most a tolerance, m, from it; bool, (n,)."""
    import igl

    # From the middle of the surface, because the winding number is computed in single precision: it is then
    # in doubt only within about 1e-7 of the extent from the surface, where the distance decides.
    middle = surface.bounds.mean(axis=0)
    vertices, faces = surface.vertices - middle, np.asarray(surface.faces)
    points = points - middle
    inside = igl.fast_winding_number(vertices, faces, points) > 0.5
    unsigned = igl.SignedDistanceType.SIGNED_DISTANCE_TYPE_UNSIGNED
    distance = igl.signed_distance(points, vertices, faces, unsigned, 0, tolerance)[0]
    return inside | (distance <= tolerance)  # farther away the distance is NaN


def volume_in_surface(surface: Any, lower: np.ndarray, upper: np.ndarray) -> float:
    """Volume, m³, of the part of the solid in a surface that is between two corners, m, (3,)."""
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
    """See ``surface_in_file``; ``shown`` names the file in errors."""
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
