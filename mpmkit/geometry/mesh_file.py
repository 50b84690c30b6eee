"""Files that hold a surface mesh: those of users in whatever format, and our copies of them in one."""

from __future__ import annotations

import contextlib
import io

import numpy as np

from ..errors import CaseError


def read_surface(path: str, shown: str) -> tuple[np.ndarray, np.ndarray]:
    """Corners (v, 3) and triangles (t, 3) of a file; quadrilaterals are split in two.

    Raises:
        CaseError: it cannot be read, or holds no surface; the sentence calls the file ``shown``.
    """
    import meshio  # here, because it is slow to import and most cases have no mesh

    try:
        # meshio prints its complaints and, for some files, leaves by sys.exit.
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            data = meshio.read(path)
        blocks = [block.data for block in data.cells if block.type == "triangle"]
        for block in data.cells:
            if block.type == "quad":
                blocks += [block.data[:, [0, 1, 2]], block.data[:, [0, 2, 3]]]
        vertices = np.asarray(data.points, dtype=float)
    except (Exception, SystemExit):
        raise CaseError(
            f"the mesh's file is {shown}, but meshio cannot read it: "
            "a surface mesh such as STL, OBJ or PLY is needed"
        ) from None
    if vertices.ndim != 2 or vertices.shape[1] != 3 or sum(map(len, blocks)) == 0:
        raise CaseError(f"the mesh's file is {shown}, but it has no triangles in space")
    if not np.isfinite(vertices).all():
        raise CaseError(f"the mesh's file is {shown}, but some of its corners are not finite numbers")
    return vertices, np.concatenate(blocks).astype(np.int64)


def as_ply(vertices: np.ndarray, faces: np.ndarray) -> bytes:
    """A binary PLY file of a surface, from which ``read_surface`` gets every bit back, in the same order.

    By hand, because the names of copies are made from these bytes: a library would put its version in them.
    """
    axes = "".join(f"property double {axis}\n" for axis in "xyz")
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{axes}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    triangles = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    triangles["count"], triangles["corners"] = 3, faces
    return head.encode() + vertices.astype("<f8").tobytes() + triangles.tobytes()
