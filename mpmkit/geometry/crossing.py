"""Whether a closed surface crosses itself."""

from __future__ import annotations

import numpy as np

_POINTS = 1 << 15
"""Points on the surface that are checked; undetected parts are below a ten-thousandth of the area."""

_OFF = 1e-5
"""Distance from the surface, as a part of its extent: above the error of winding numbers in float32."""


def crossing(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray | None:
    """A point, (3,), where the winding number is neither 0 nor 1, or None if the surface is sound.

    The winding number of a surface with its normals outwards is 1 inside and 0 outside. Where shells overlap
    it is 2 or more, and a part of one surface is inside the other. Where a cavity leaves its solid, or a
    surface crosses itself with its inside out, it is -1. Solids that touch have 1 on either side.

    Args:
        vertices: corners, m, (v, 3).
        faces: triangles of a closed surface, normals outwards, (t, 3).
    """
    import igl

    lower, upper = vertices.min(axis=0), vertices.max(axis=0)
    extent = float((upper - lower).max())
    if not 0 < extent < np.inf:
        return None
    vertices = (vertices - (lower + upper) / 2) / extent
    a, b, c = vertices[faces.T]
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1)
    rng = np.random.default_rng(0)
    # Spread evenly over the area, and somewhere in the triangle.
    reached = np.cumsum(area)
    which = np.searchsorted(reached, (np.arange(_POINTS) + rng.random(_POINTS)) / _POINTS * reached[-1])
    which = np.minimum(which, len(faces) - 1)
    u, v = rng.random((2, _POINTS, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    points = a[which] + u * (b - a)[which] + v * (c - a)[which]
    off = _OFF * normal[which] / np.maximum(area[which], 1e-300)[:, None]
    points = np.concatenate([points - off, points + off])
    winding = igl.fast_winding_number(vertices, faces, points)
    doubtful = points[(winding > 1.4) | (winding < -0.4)]
    if len(doubtful):  # the fast one is an approximation
        exact = igl.winding_number(vertices, faces, doubtful[:64])
        wrong = doubtful[:64][(exact > 1.5) | (exact < -0.5)]
        if len(wrong):
            return wrong[0] * extent + (lower + upper) / 2
    return None
