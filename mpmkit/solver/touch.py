"""Contact between material and walls: a wall acts at a node only in steps in which material touches it.

A particle has weight on the nodes of a wall when it is still up to a cell away. If the wall stopped it there,
the cell in front of the wall would stay half empty, and material that sticks to the wall would get only half
of the stress. So a node is free until the box of a particle with weight on it comes within
``kernels.touch.REACH`` of the wall, or until the node is full: in disorder, single boxes can stay farther
away although there is no space left.
"""

from __future__ import annotations

import math

import numpy as np

from ..contracts import ShapeFunction
from ..kernels import touch
from .grid import Grid, Window
from .node_volumes import node_volumes
from .particles import Particles
from .sorting import Sorting

RINGS = 8
"""Number of boxes, two per cell, from an axis to the reach of the shape functions of its nodes."""


class Touch:
    """Marks the touched nodes of the walls in every step again; so it has no state."""

    def __init__(self, grid: Grid, particles: Particles, radial: bool, shape: ShapeFunction) -> None:
        self._particles, self._radial = particles, radial
        self._walled, self._cell_size = grid.walled, grid.cell_size
        self._walls = np.where(
            grid.walls, np.stack([np.zeros_like(grid.cells), grid.cells], axis=1), touch.NOWHERE
        )
        self._mark = touch.mark(grid.dim, shape.support)
        self._on_axis = _room_on_axis(shape) if radial else math.inf
        self._sorts, self._room = -1, np.zeros(0)

    def mark(
        self, window: Window, sorting: Sorting, base: np.ndarray, weight: np.ndarray, begins: bool
    ) -> None:
        """Mark the nodes of a window, for the weights of the step; ``begins``: for the first in a run."""
        if not self._walled:
            return
        p, active = self._particles, sorting.active
        if self._sorts != sorting.sorts:
            room = node_volumes(window, self._radial, self._on_axis)
            self._sorts, self._room = sorting.sorts, room[active.mirrors[:, 2]]
        self._mark(
            window.nodes, window.pairs, window.strides, window.lower, self._walls, active.faces,
            active.mirrors, active.plane_first, sorting.tasks, base, weight, p.position, p.velocity,
            p.half_size, p.volume, self._room, self._cell_size, begins,
        )  # fmt: skip


def _room_on_axis(shape: ShapeFunction) -> float:
    """Volume of a node on the axis over 2 π Δx², for boxes without gaps: 1/6 for cpGIMP."""
    # Columns of two axes, as in a scene, for which the kernels of the shape function are compiled.
    position, half_size = np.empty((RINGS, 2)), np.full((RINGS, 2), 0.25)
    position[:] = (np.arange(RINGS)[:, None] + 0.5) / 2
    base, hoop = np.zeros((RINGS, 2), dtype=np.int32), np.zeros((RINGS, shape.support))
    weight, gradient = np.zeros((2, RINGS, 2, shape.support))
    tables = base[:, 0], weight[:, 0], gradient[:, 0]
    shape.fill_radial(position[:, 0], half_size[:, 0], 1.0, *tables, hoop)
    on_axis = base[:, :1] + np.arange(shape.support) == 0
    return float((position[:, :1] / 2 * weight[:, 0])[on_axis].sum())
