"""The distance of a closed surface of triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .ball import unit
from .solid import Found, Solid


@dataclass(frozen=True)
class SurfaceMesh(Solid):
    """Exact distance of the nearest triangle, found in a tree of boxes; needs libigl.

    The sign is that of the angle-weighted pseudonormal of the nearest face, edge or corner, which is right
    for every closed surface (Bærentzen & Aanæs, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243-253).

    Args:
        vertices: m, (v, 3).
        faces: (t, 3), normals outwards.
    """

    vertices: np.ndarray
    faces: np.ndarray

    def distance(self, x: np.ndarray) -> Found:
        import igl

        if len(x) == 0:
            return np.empty(0), np.empty((0, 3))
        kind = igl.SignedDistanceType.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
        distance, _, nearest, normal = igl.signed_distance(x, self.vertices, self.faces, kind)
        distance = np.asarray(distance, dtype=float).reshape(len(x))
        outwards, length = unit(x - nearest)
        gradient = np.where(distance < 0, -1.0, 1.0)[:, None] * outwards
        on_it = length <= 1e-9 * float(np.ptp(self.vertices, axis=0).max())
        gradient[on_it] = unit(np.asarray(normal)[on_it])[0]  # too near for a direction
        return distance, gradient

    def hull(self) -> tuple[np.ndarray, float]:
        return self.vertices, 0.0
