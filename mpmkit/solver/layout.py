"""The order in which particles are stored: group by group, slab by slab of cells, cell by cell.

Slabs are what P2G runs over in parallel (see ``kernels.scatter``). They stay valid while no particle drifts
more than one cell out of its own, so that sorting is rare and costs nothing in between.
"""

from __future__ import annotations

import numpy as np
import psutil

from ..kernels.compile import CHUNK
from ..kernels.locate import LOST, STRAYED, locate, wrap
from ..kernels.scatter import NODE
from .grid import Grid, Window
from .particles import Particles

SLAB_WIDTH = 5
"""Cells in a slab along the first axis. A particle that has drifted a cell out of its slab touches nodes
from 2 below to 2 above the slab's cells and one more; with 5 cells two slabs of one colour never meet."""
DRIFT = 2
"""Cells that a particle may drift out of the box of the last sort, along the axes that have no slabs."""


class Scattered(Exception):
    """The material has spread over more nodes than fit into memory.

    Attributes:
        particle: index of the one farthest out.
    """

    def __init__(self, particle: int) -> None:
        super().__init__(f"particle at index {particle} is too far out")
        self.particle = particle


class Layout:
    """Keeps the particles sorted and the window over them."""

    def __init__(self, grid: Grid, particles: Particles, window: Window) -> None:
        self.grid = grid
        self.particles = particles
        self.window = window
        self.slabs = np.zeros((len(particles.groups), 2), dtype=np.int64)
        self.first_slab = 0
        self.sorts = 0
        self._low = np.zeros(grid.dim, dtype=np.int64)
        self._high = np.zeros(grid.dim, dtype=np.int64)
        self._verdicts = np.empty((len(particles) // CHUNK + 1, 2), dtype=np.int64)
        self._periodic = [a for a in range(grid.dim) if grid.periodic[a]]

    def refresh(self) -> int | None:
        """Sort and move the window if a particle has strayed. Returns a particle that is lost, if any is."""
        position = self.particles.position
        for axis in self._periodic:
            wrap(position, axis, self.grid.extent[axis])
        if self.sorts == 0:
            return self._sort()
        verdict, who = locate(
            position, self.particles.half_size, self.grid.extent, 1 / self.grid.cell_size, self.slabs,
            SLAB_WIDTH, self.first_slab, self._low, self._high, self._verdicts,
        )  # fmt: skip
        if verdict == LOST:
            return int(who)
        if verdict == STRAYED:
            return self._sort()
        return None

    def _sort(self) -> int | None:
        particles, grid = self.particles, self.grid
        inside = np.all((particles.position >= 0) & (particles.position <= grid.extent), axis=1)
        if not inside.all():
            return int(np.argmin(inside))
        cell = (particles.position * (1 / grid.cell_size)).astype(np.int64)
        low, high = cell.min(axis=0), cell.max(axis=0)
        self._low, self._high = low - DRIFT, high + DRIFT
        self._require_memory(cell)
        self.window.cover(self._low, self._high)
        slab = cell[:, 0] // SLAB_WIDTH
        self.first_slab = int(slab.min())
        count = int(slab.max()) - self.first_slab + 1
        key = np.zeros(len(particles), dtype=np.int64)
        for g, group in enumerate(particles.groups):
            key[group.part] = g
        for a in range(grid.dim):
            key = key * (int(high[a] - low[a]) + 1) + (cell[:, a] - low[a])
        order = np.argsort(key, kind="stable")
        particles.reorder(order)
        slab = slab[order] - self.first_slab
        self.slabs = np.empty((len(particles.groups), count + 1), dtype=np.int64)
        for g, group in enumerate(particles.groups):
            edges = np.searchsorted(slab[group.part], np.arange(count + 1))
            self.slabs[g] = group.part.start + edges
        self.sorts += 1
        return None

    def _require_memory(self, cell: np.ndarray) -> None:
        """Refuse a window that does not fit: a particle thrown out could make it as large as the domain."""
        low, high = self.window.reach(self._low, self._high)
        if float(np.prod((high - low + 1).astype(float))) * NODE * 8 > psutil.virtual_memory().available:
            away = np.abs(cell - np.median(cell, axis=0)).max(axis=1)
            raise Scattered(int(np.argmax(away)))
