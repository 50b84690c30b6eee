"""Averages of particle fields over the grid: from particles to nodes and back."""

from __future__ import annotations

import numpy as np

from ..kernels import nodes
from ..kernels.gather import gather_scalar
from ..kernels.scatter import scatter_pairs
from .grid import Window
from .particles import Particles
from .sorting import Sorting
from .walls import Walls


class Averager:
    """f_n = Σ w N f / Σ w N at the nodes, and Σ N f_n at the particles, with the weights N of the present
    step.

    Args:
        particles: the particles whose fields are averaged.
        window: the nodes; ``pairs`` holds the sums temporarily, ``average`` the averages.
        walls: they fold and fill ghosts as the faces of the grid do.
        sorting: order of the particles, and the nodes that they can touch.
        base, weight: tables of the shape function, computed in every step.
    """

    def __init__(
        self,
        particles: Particles,
        window: Window,
        sorting: Sorting,
        walls: Walls,
        base: np.ndarray,
        weight: np.ndarray,
    ) -> None:
        dim, support = weight.shape[1:]
        self.particles = particles
        self.window = window
        self.walls = walls
        self.sorting = sorting
        self._tables = base, weight
        self._scatter_pairs, self._gather_scalar = scatter_pairs(dim, support), gather_scalar(dim, support)

    def sums(self, values: np.ndarray, weight: np.ndarray) -> None:
        """Σ w N and Σ w N f into ``window.pairs``, which must be empty."""
        w = self.window
        self._scatter_pairs(w.pairs, w.strides, w.lower, self.sorting.tasks, *self._tables, weight, values)

    def at_nodes(self, values: np.ndarray, weight: np.ndarray, crowding: np.ndarray | None = None) -> None:
        """Σ w N f / Σ w N, over the crowding if given, into ``window.average``; 0 without material."""
        w, active = self.window, self.sorting.active
        self.sums(values, weight)
        if crowding is not None:
            nodes.relieve_pairs(w.pairs, crowding, *active.arguments)
        self.walls.fold_pairs(w.pairs)
        nodes.divide_pairs(w.pairs, w.average, *active.arguments)
        self.walls.fill_average(w.average)

    def at_particles(self) -> np.ndarray:
        """``window.average`` interpolated to the particles, ``(n,)``."""
        w, out = self.window, np.empty(len(self.particles))
        self._gather_scalar(w.average, w.strides, w.lower, *self._tables, out)
        return out
