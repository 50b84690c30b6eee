"""All walls of a scene."""

from __future__ import annotations

import numpy as np

from ...kernels import nodes as node_kernels
from ...kernels import walls as kernels


class Walls:
    def __init__(self, walls, grid, window, sorting, particles):
        self.walls = list(walls)
        self.grid, self.window, self.sorting, self.particles = grid, window, sorting, particles
        self.time = 0.0
        self._sorts = -1

    def __bool__(self):
        return bool(self.walls)

    def begin(self, base, weight, time):
        if self._sorts != self.sorting.sorts:
            self._sorts = self.sorting.sorts
            active = np.zeros(len(self.window.nodes), dtype=np.uint8)
            for first, end in self.sorting.active.rows:
                active[first:end] = 1
            for wall in self.walls:
                wall.lay(self.window, active, time)
        else:
            for wall in self.walls:
                wall.begin(time)
        p = self.particles
        for wall in self.walls:
            wall.mark(p.position, p.half_size, base, weight)

    def fold(self, momentum, forces):
        for wall in self.walls:
            wall.fold(momentum, forces)

    def mapped(self):
        for wall in self.walls:
            wall.act(False, 0.0)
        for wall in reversed(self.walls):
            wall.fill(False)
        self._fill_faces(1 + self.grid.dim)

    def solved(self, dt):
        for wall in self.walls:
            wall.act(True, dt)
        for wall in reversed(self.walls):
            wall.fill(True, dt)
        self._fill_faces(1 + 2 * self.grid.dim)

    def _fill_faces(self, last):
        active = self.sorting.active
        node_kernels.fill(self.window.nodes, active.faces, active.mirrors, active.plane_first, 1, last, True)

    def fold_pairs(self, pairs):
        for w in self.walls:
            kernels.fold_pairs(pairs, w.behind, w._at, w.image, w.image_weight, w.touched, w._pair)

    def fill_average(self, average):
        for w in reversed(self.walls):
            kernels.fill_average(average, w.behind, w._at, w.image, w.image_weight, w.touched, w._pair)
