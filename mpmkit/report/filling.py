"""The gaps between the boxes of neighbouring particles.

Boxes of constant size separate when the material is stretched, and a picture of an intact body would show
stripes. Neighbours within about a cell share nodes: on the grid they are connected, so the gaps are filled.
"""

from __future__ import annotations

import numpy as np
from matplotlib.tri import Triangulation

from .section import Section

REACH = 1.5
"""Cells within which two particles of a body count as neighbours. A wider gap is a gap and stays open."""


def triangles_between(section: Section, cell_size: float) -> np.ndarray:
    """Triples ``(m, 3)`` of particles of one body, all within reach of each other, without overlap."""
    found = [np.empty((0, 3), dtype=np.int64)]
    for body in np.unique(section.body):
        members = np.flatnonzero(section.body == body)
        triples = members[_delaunay(section.centre[members])]
        corners = section.centre[triples]
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1)
        found.append(triples[(edges <= REACH * cell_size).all(axis=1)])
    return np.concatenate(found)


def _delaunay(points: np.ndarray) -> np.ndarray:
    try:
        return Triangulation(*points.T).triangles.astype(np.int64)
    except (ValueError, RuntimeError):  # fewer than three points, or all of them on a line
        return np.empty((0, 3), dtype=np.int64)
