"""Surface mesh files: those of users in many formats, and mpmkit's copies in one format."""

from __future__ import annotations

import contextlib
import io
import re
import stat
from collections.abc import Iterator
from os import stat_result
from pathlib import Path

import numpy as np

from ..errors import CaseError
from .obj_file import read_obj
from .polygons import Unusable, fans
from .truncation import ply_head, require_whole_stl

LARGEST = 2**30
"""Largest size of a mesh file, bytes: 1 GiB, twenty million triangles of a binary STL file."""

_BESIDE = re.compile("vertex|line")
"""Blocks of cells without area; a file may contain them in addition to a surface, and they are ignored."""

Surface = tuple[np.ndarray, np.ndarray]
"""Corners (v, 3) and triangles (t, 3)."""


def read_surface(path: str, shown: str) -> Surface:
    """Corners (v, 3) and triangles (t, 3) of a file; polygons are split into fans of triangles.

    Raises:
        CaseError: it cannot be read, or holds no surface; the sentence calls the file ``shown``.
    """
    require_file(path, shown)
    suffix = Path(path).suffix.lower()
    try:
        if suffix == ".obj":
            vertices, faces = read_obj(path)
        elif suffix == ".stl":
            require_whole_stl(path)
            vertices, faces = _by_meshio_or_trimesh(path, "stl")
        elif suffix == ".ply":
            plain = ply_head(path).plain
            vertices, faces = _by_meshio_or_trimesh(path, "ply") if plain else _by_trimesh(path, "ply")
        else:
            vertices, faces = _by_meshio(path)
        _require_surface(vertices, faces)
    except Unusable as error:
        raise CaseError(f"the mesh's file is {shown}, but {error}") from None
    except (Exception, SystemExit):
        raise CaseError(
            f"the mesh's file is {shown}, but it cannot be read: it is damaged or truncated, or not of a "
            "kind that is known; a surface mesh such as STL, OBJ or PLY is needed"
        ) from None
    return vertices, faces


def require_file(path: str, shown: str) -> stat_result:
    """The file status of a file that may be read as a mesh.

    Raises:
        CaseError: it is missing, not a file (a folder, a pipe, a device), empty, or too large.
    """
    try:
        found = Path(path).stat()
    except (OSError, ValueError):
        raise CaseError(f"the mesh's file is {shown}, but there is no such file") from None
    if not stat.S_ISREG(found.st_mode):
        kind = "a folder" if stat.S_ISDIR(found.st_mode) else "a pipe or a device"
        raise CaseError(f"the mesh's file is {shown}, but that is {kind}; it must be a file")
    if found.st_size == 0:
        raise CaseError(f"the mesh's file is {shown}, but it is empty")
    if found.st_size > LARGEST:
        raise CaseError(
            f"the mesh's file is {shown}, but it has {found.st_size / 2**30:.3g} GiB; "
            f"it may have at most {LARGEST / 2**30:g} GiB"
        )
    return found


def _require_surface(vertices: np.ndarray, faces: np.ndarray) -> None:
    if len(faces) == 0 or vertices.ndim != 2 or vertices.shape[1] != 3:
        raise Unusable("it has no triangles in space")
    if not _in_range(vertices, faces):
        raise Unusable(f"its faces name corners that it does not have; it has {len(vertices)}")
    if not np.isfinite(vertices).all():
        raise Unusable("some of its corners are not finite numbers")


def _in_range(vertices: np.ndarray, faces: np.ndarray) -> bool:
    return bool(len(faces) == 0 or (faces.min() >= 0 and faces.max() < len(vertices)))


def _by_meshio_or_trimesh(path: str, kind: str) -> Surface:
    """Read by meshio; files that meshio cannot read, such as STL with capitals or blank lines, by trimesh."""
    try:
        return _by_meshio(path)
    except Unusable:
        raise
    except (Exception, SystemExit):
        return _by_trimesh(path, kind)


def _by_meshio(path: str) -> Surface:
    import meshio  # here, because it is slow to import and most cases have no mesh

    with _silence():
        if path.lower().endswith(".msh") and not _is_gmsh(path):
            with _Ending(io.FileIO(path)) as file:
                data = meshio.read(file, file_format="ansys")
        else:
            data = meshio.read(path)
    polygons = []
    for block in data.cells:
        if block.type in ("triangle", "quad") or block.type.startswith("polygon"):
            polygons.append(np.asarray(block.data))
        elif not _BESIDE.match(block.type):
            raise Unusable(
                f"it has cells of the kind '{block.type}', which are not used; "
                "only the surface must be in the file, as triangles or other polygons"
            )
    return np.asarray(data.points, dtype=float), fans(polygons)


def _is_gmsh(path: str) -> bool:
    """Whether a .msh file is of Gmsh and not of Ansys; meshio would try both."""
    with open(path, "rb") as file:
        return file.read(64).lstrip()[:1] == b"$"


class _Ending(io.BufferedReader):
    """A file whose end is an error where one byte is wanted: meshio's reader of Ansys' .msh files waits for
    a bracket for ever if the file is truncated."""

    def read(self, size: int | None = -1, /) -> bytes:
        content = super().read(size)
        if size == 1 and not content:
            raise Unusable("it is truncated or damaged: a bracket is not closed")
        return content


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Suppress messages that the readers print, and sys.exit, which meshio calls for some files."""
    with (
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(io.StringIO()),
        np.errstate(all="ignore"),
    ):
        yield


def _by_trimesh(path: str, kind: str) -> Surface:
    import trimesh  # it splits polygons itself

    with open(path, "rb") as file, _silence():
        found = trimesh.load_mesh(file, file_type=kind, process=False)
    return np.array(found.vertices, dtype=float), np.array(found.faces, dtype=np.int64)


def as_ply(vertices: np.ndarray, faces: np.ndarray) -> bytes:
    """A binary PLY file of a surface, from which ``read_surface`` gets every bit back, in the same order.

    It is written without a library, because the names of copies are made from these bytes: a library could
    write its version into them.
    """
    axes = "".join(f"property double {axis}\n" for axis in "xyz")
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{axes}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    triangles = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    triangles["count"], triangles["corners"] = 3, faces
    return head.encode() + vertices.astype("<f8").tobytes() + triangles.tobytes()
