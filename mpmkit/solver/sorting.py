"""The order in which particles are stored: group by group, and within a group by ``kernels.sort``.

P2G runs over blocks of cells in parallel. The blocks stay valid until a particle moves more than one cell out
of its own cell, so that sorting is rare.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..kernels import sort
from ..kernels.locate import LOST, STRAYED, locate, put_back, wrap
from ..kernels.scatter import NODE
from ..kernels.touch import REACH
from .active_nodes import ActiveNodes
from .available_memory import available_memory
from .grid import Grid, Window
from .particles import Particles
from .stateful import State, plain_state, restore_plain
from .tasks import TASKS, cuts

DRIFT = 1
"""Cells that a particle may move out of its box of the last sort."""


class Scattered(Exception):
    """The material has spread over more nodes than the memory can hold.

    Attributes:
        particle: index of the outermost particle.
    """

    def __init__(self, particle: int) -> None:
        super().__init__(f"particle at index {particle} is too far out")
        self.particle = particle


class Sorting:
    """Keeps the particles sorted, the window over them, and the nodes that they can reach."""

    def __init__(self, grid: Grid, particles: Particles, window: Window) -> None:
        self.grid = grid
        self.particles = particles
        self.window = window
        self.tasks = np.zeros((len(particles.groups), 1 << grid.dim, TASKS + 1), dtype=np.int64)
        self.sorts = 0
        self._locate = locate(grid.dim)
        self._low = np.zeros(grid.dim, dtype=np.int64)
        self._high = np.zeros(grid.dim, dtype=np.int64)
        self._block_first = np.zeros((len(particles.groups), 1), dtype=np.int64)
        self._block_cell = np.zeros((0, grid.dim), dtype=np.int64)
        self._verdicts = np.zeros((0, 2), dtype=np.int64)
        self._periodic = [a for a in range(grid.dim) if grid.periodic[a]]
        ends = np.stack([np.zeros(grid.dim), grid.extent], axis=1)
        self._walls = np.where(grid.walls, ends, [-np.inf, np.inf])
        self._walled = [a for a in range(grid.dim) if grid.walls[a].any()]

    def refresh(self, cells: np.ndarray, scratch: np.ndarray) -> int | None:
        """Sort and move the window if a particle has left its range. Return the index of a particle outside
        the grid, if any.

        Args:
            cells: ``(n, dim)`` integers of 32 bits, for the particles' cells in a sort.
            scratch: doubles, as many as the widest array of the particles has.
        """
        position = self.particles.position
        for axis in self._periodic:
            wrap(position, axis, self.grid.extent[axis])
        for axis in self._walled:
            put_back(position, axis, *self._walls[axis], REACH * self.grid.cell_size)
        if self.sorts == 0:
            return self._sort(cells, scratch)
        verdict, who = self._locate(
            position, self.particles.half_size, self.grid.extent, 1 / self.grid.cell_size, self._block_first,
            self._block_cell, self._low, self._high, self._verdicts,
        )  # fmt: skip
        if verdict == LOST:
            return int(who)
        if verdict == STRAYED:
            return self._sort(cells, scratch)
        return None

    def _sort(self, cell: np.ndarray, scratch: np.ndarray) -> int | None:
        particles, grid = self.particles, self.grid
        inside = np.all((particles.position >= 0) & (particles.position <= grid.extent), axis=1)
        if not inside.all():
            return int(np.argmin(inside))
        n, dim = particles.position.shape
        sort.find_cells(particles.position, 1 / grid.cell_size, cell)
        low, high = cell.min(axis=0).astype(np.int64), cell.max(axis=0).astype(np.int64)
        self._low, self._high = low - DRIFT, high + DRIFT
        self._require_memory(cell)
        self.window.cover(self._low, self._high)

        blocks = (high - low) // sort.BLOCK_WIDTH + 1
        count = int(np.prod(blocks))
        index = np.empty(count, dtype=np.int64)
        self._block_cell = np.empty((count, dim), dtype=np.int64)
        first_of_colour = sort.number_blocks(blocks, index, self._block_cell)
        self._block_cell += low
        key = np.empty(n, dtype=np.int64)
        sort.find_keys(cell, low, blocks, index, key)
        order = np.empty(n, dtype=np.int64)
        first = np.empty(count * sort.BLOCK_WIDTH**dim + 1, dtype=np.int64)
        self._block_first = np.empty((len(particles.groups), count + 1), dtype=np.int64)
        for g, group in enumerate(particles.groups):
            sort.counting_sort(key, group.part.start, group.part.stop, first, order)
            self._block_first[g] = first[:: sort.BLOCK_WIDTH**dim]
        particles.reorder(order, scratch)
        self._verdicts = np.empty((count, 2), dtype=np.int64)
        self._share_out(first_of_colour)
        self.active = self._active_nodes()
        self.sorts += 1
        return None

    def state(self) -> State:
        """The data that determine the order of the particles and the next sort."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Restore a state; the particles and the window must be restored before."""
        restore_plain(self, state)
        if self.sorts:
            self.active = self._active_nodes()

    def _share_out(self, first_of_colour: np.ndarray) -> None:
        """Cut the blocks of every colour into tasks of about equal load, all groups together."""
        load = (self._block_first - self._block_first[:, :1]).sum(axis=0)
        self.tasks = np.empty((len(self.particles.groups), len(first_of_colour) - 1, TASKS + 1), np.int64)
        for colour, (begin, end) in enumerate(pairwise(first_of_colour)):
            self.tasks[:, colour] = self._block_first[:, begin + cuts(load[begin : end + 1])]

    def _active_nodes(self) -> ActiveNodes:
        """The nodes that particles can touch until the next sort: see ``kernels.locate``."""
        occupied = (np.diff(self._block_first, axis=1) > 0).any(axis=0)
        cell = self._block_cell[occupied]
        low, high = cell - DRIFT, cell + sort.BLOCK_WIDTH - 1 + DRIFT
        return ActiveNodes(self.window, np.maximum(low, self._low), np.minimum(high, self._high))

    def _require_memory(self, cell: np.ndarray) -> None:
        """Refuse a window that needs too much memory: one ejected particle can make it very large."""
        missing = self.window.missing(self._low, self._high)
        if missing and missing * NODE * 8 > available_memory():
            away = np.abs(cell - np.median(cell, axis=0)).max(axis=1)
            raise Scattered(int(np.argmax(away)))
