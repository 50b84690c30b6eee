"""Turning the triangles of a closed surface so that each looks out of the solid."""

from __future__ import annotations

from collections import deque

import numpy as np

from .parity import inside_surface


def outward(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The faces (t, 3) of a closed surface, turned so that their normals point out of the solid.

    Neighbours are made to agree first, shell by shell; then a shell that lies in an odd number of others is
    the wall of a cavity and encloses a negative volume, any other a positive one. (trimesh would do the
    first part with networkx and SciPy, which it does not require.)

    Args:
        vertices: m, (v, 3).
        faces: numbers of corners; each edge belongs to exactly two faces.
    """
    faces = faces.copy()
    shells, turned = _shells(faces)
    faces[turned] = faces[turned][:, ::-1]
    members = [np.flatnonzero(shells == number) for number in range(shells.max() + 1)]
    triangles = [vertices[faces[own]] for own in members]
    lower = np.array([corners.min(axis=(0, 1)) for corners in triangles])
    upper = np.array([corners.max(axis=(0, 1)) for corners in triangles])
    for number, own in enumerate(members):
        # Corners relative to one of the shell's own: far from the origin the sum would lose digits.
        corner = triangles[number][:1, 0]
        a, b, c = np.moveaxis(triangles[number] - corner, 1, 0)
        volume = np.einsum("ta,ta->", a, np.cross(b, c)) / 6
        around = np.flatnonzero(((lower < corner) & (corner < upper)).all(axis=1))
        depth = sum(bool(inside_surface(corner, triangles[k])[0]) for k in around if k != number)
        if (volume < 0) != (depth % 2 == 1):
            faces[own] = faces[own][:, ::-1]
    return faces


def _shells(faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Number of the connected shell of each face, and whether to turn it to agree with the shell's first."""
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    forward = edges[:, 0] < edges[:, 1]
    edges = np.sort(edges, axis=1)
    pairs = np.lexsort((edges[:, 1], edges[:, 0])).reshape(-1, 2)
    # Two neighbours agree if they run along their common edge in opposite directions.
    disagree = forward[pairs[:, 0]] == forward[pairs[:, 1]]
    neighbours: list[list[tuple[int, bool]]] = [[] for _ in range(len(faces))]
    for (one, two), differ in zip((pairs // 3).tolist(), disagree.tolist(), strict=True):
        neighbours[one].append((two, differ))
        neighbours[two].append((one, differ))
    shell = [-1] * len(faces)
    turned = [False] * len(faces)
    count = 0
    for seed in range(len(faces)):
        if shell[seed] >= 0:
            continue
        shell[seed] = count
        queue = deque([seed])
        while queue:
            face = queue.popleft()
            for other, differ in neighbours[face]:
                if shell[other] < 0:
                    shell[other], turned[other] = count, turned[face] != differ
                    queue.append(other)
        count += 1
    return np.array(shell), np.array(turned)
