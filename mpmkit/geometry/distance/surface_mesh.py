"""The distance of a closed surface of triangles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...contracts.solid import Found, Solid
from .ball import unit

_EDGE = 1e-7
"""Part of a triangle's height within which a point counts as on the edge, far above rounding."""


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
        if len(x) == 0:
            return np.empty(0), np.empty((0, 3))
        square, face, nearest = self._tree.squared_distance(
            self.vertices, self.faces, np.ascontiguousarray(x)
        )
        outwards, length = unit(x - nearest)
        normal = self._pseudonormals[face, self._feature(face, nearest)]
        sign = np.where((outwards * normal).sum(axis=1) < 0, -1.0, 1.0)
        gradient = sign[:, None] * outwards
        on_it = length <= 1e-9 * float(np.ptp(self.vertices, axis=0).max())
        gradient[on_it] = normal[on_it]  # too close to the surface to compute a direction
        return sign * np.sqrt(square), gradient

    def hull(self) -> tuple[np.ndarray, float]:
        return self.vertices, 0.0

    @cached_property
    def _tree(self) -> Any:
        import igl

        tree = igl.AABB()
        tree.init(self.vertices, self.faces)
        return tree

    @cached_property
    def _pseudonormals(self) -> np.ndarray:
        """Unit normals of each triangle's own, (t, 7, 3): of the face, of the edges opposite to its corners,
        and of its corners."""
        corners = self.vertices[self.faces]
        sides = np.roll(corners, -1, axis=1) - corners
        along = unit(sides.reshape(-1, 3))[0].reshape(sides.shape)
        face = unit(np.cross(sides[:, 0], sides[:, 1]))[0]
        angle = np.arccos(np.clip(-(along * np.roll(along, 1, axis=1)).sum(axis=2), -1.0, 1.0))
        of_corners = np.zeros_like(self.vertices)
        np.add.at(of_corners, self.faces, angle[:, :, None] * face[:, None])
        opposite = [np.roll(self.faces, -1, axis=1), np.roll(self.faces, -2, axis=1)]
        ends = np.sort(np.stack(opposite, axis=2), axis=2)
        edges, edge = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
        edge = edge.reshape(self.faces.shape)
        of_edges = np.zeros((len(edges), 3))
        np.add.at(of_edges, edge, np.repeat(face[:, None], 3, axis=1))
        return np.concatenate(
            [face[:, None], unit(of_edges)[0][edge], unit(of_corners)[0][self.faces]], axis=1
        )

    def _feature(self, face: np.ndarray, place: np.ndarray) -> np.ndarray:
        """Index of the pseudonormal at a point of a face, (k,): 0 inside, 1-3 on an edge, 4-6 at a corner."""
        a, b, c = (self.vertices[self.faces[face, i]] for i in range(3))
        normal = np.cross(b - a, c - a)
        area = np.maximum((normal * normal).sum(axis=1), 1e-300)
        parts = np.stack(  # barycentric coordinates
            [
                (np.cross(e, place - start) * normal).sum(axis=1) / area
                for e, start in ((c - b, b), (a - c, c), (b - a, a))
            ],
            axis=1,
        )
        off = parts <= _EDGE
        on_edge, at_corner = off.sum(axis=1) == 1, off.sum(axis=1) >= 2
        found = np.where(on_edge, 1 + np.argmax(off, axis=1), 0)
        return np.where(at_corner, 4 + np.argmax(parts, axis=1), found)
