"""One wall of a scene."""

from __future__ import annotations

import numpy as np

from ...kernels import walls as kernels
from ..grid import Grid, Window
from .contact_nodes import ContactNodes

MARGIN = 1.0
"""Cells that a wall may move before the nodes near it are looked for anew."""
SWEEPS = 3
"""Turns in which impulses at neighbouring places are brought together."""


class Wall:
    """A surface with a contact, and the nodes of the window at which it acts.

    Attributes:
        impulse: N s, (dim,), that it has given to the material since the last look.
    """

    def __init__(self, name, surface, contact, grid: Grid) -> None:
        self.name = name
        self.surface = surface
        self.contact = contact
        self.grid = grid
        self.moving = surface.moving
        self.impulse = np.zeros(grid.dim)
        self.mapped_impulse = np.zeros(grid.dim)
        self._candidates = None

    # --- Where it is

    def lay(self, window: Window, active: np.ndarray, time: float) -> None:
        """Find the nodes near the wall in a window that has been laid anew."""
        grid, dim = self.grid, self.grid.dim
        shape = window.shape[:dim]
        self._window, self._active = window, active
        number = np.stack(np.meshgrid(*[np.arange(n) for n in shape], indexing="ij"), axis=-1).reshape(-1, dim)
        number = number + window.lower
        count = len(active)
        self.dense = np.full(count, kernels.FAR)
        self.touched = np.zeros(count, dtype=np.uint8)
        self._taken = np.zeros(count, dtype=np.uint8)
        self._all = number
        # A node behind the axis of an axisymmetric scene has its image in front of it.
        self._place = grid.lower + number * grid.cell_size
        if grid.radial:
            self._place[:, 0] = np.abs(self._place[:, 0])
        self._free = self._open_axes(number)
        self._find(time)

    def _open_axes(self, number):
        from ...kernels.nodes import MIRROR, STICK
        free = np.full(len(number), (1 << self.grid.dim) - 1, dtype=np.int64)
        for a in range(self.grid.dim):
            for side, plane in enumerate((0, self.grid.cells[a])):
                face = self.grid.faces[a, side]
                on = number[:, a] == plane
                if face == MIRROR:
                    free[on] &= ~(1 << a)
                elif face == STICK:
                    free[on] = 0
        return free

    def _find(self, time: float) -> None:
        d, _ = self.surface.distance(self._place, time)
        d = d / self.grid.cell_size
        room = kernels.NEAR + (MARGIN if self.moving else 0.0)
        self._at = np.flatnonzero(np.abs(d) <= room)
        self.dense[:] = kernels.FAR
        self._moved = 0.0
        self._time = time
        k, dim = len(self._at), self.grid.dim
        self._at_wall = np.empty(k, dtype=np.int64)
        self._ghost = np.empty(k, dtype=np.int64)
        self.index = np.zeros((k, 1 << dim), dtype=np.int64)
        self.weight = np.zeros((k, 1 << dim))
        self.image = np.zeros((k, 1 << dim), dtype=np.int64)
        self.image_weight = np.zeros((k, 1 << dim))
        self._pair = np.zeros((k, 2))
        self._behind = np.empty(k, dtype=np.int64)
        self._held = np.zeros((k, 1 + dim))
        self._impulse = np.zeros((k, dim))
        self._number = np.ascontiguousarray(self._all[self._at])
        self._x = np.ascontiguousarray(self._place[self._at])
        self._acting = np.empty(k, dtype=np.int64)
        self._share = np.zeros((k, 1 + (1 << dim)))
        self._stiffness, self._velocity, self._inner = np.zeros((3, k, dim))
        self._sort(time)

    def _sort(self, time: float) -> None:
        window = self._window
        d, self.normal = self.surface.distance(self._x, time)
        if self.grid.radial:  # the image of a node behind the axis has its normal turned round
            behind = self._number[:, 0] < 0
            self.normal = np.where(behind[:, None], self.normal * [-1.0, 1.0], self.normal)
        self.d = d / self.grid.cell_size
        self.wall_velocity = self.surface.velocity(self._x, time)
        self.dense[self._at] = self.d
        self._taken[self._at] = 0
        dim = self.grid.dim
        count, ghosts = kernels.find_nodes(
            self._at, self._number, self.d, self.normal, window.lower, np.array(window.shape),
            np.array(window.strides), self._active, self._taken, self._at_wall, self._ghost, self.index, self.weight,
        )
        n = kernels.find_images(
            self._at, self._number, self.d, self.normal, window.lower, np.array(window.shape),
            np.array(window.strides), self._active, self._taken, self._behind, self.image, self.image_weight)
        self.behind = self._behind[:n]
        self.at_wall, self.ghost = self._at_wall[:count], self._ghost[:ghosts]

    def begin(self, time: float) -> None:
        """Move to where the wall is now."""
        if not self.moving:
            return
        self._moved += self.surface.fastest(self._time, time) * (time - self._time) / self.grid.cell_size
        self._time = time
        if self._moved > MARGIN:
            self._find(time)
        else:
            self._sort(time)

    def mark(self, position, half_size, base, weight):
        w = self._window
        self.touched[self._at] = 0
        kernels.mark_touched(position, half_size, 1 / self.grid.cell_size, base, weight, w.lower,
                             np.array(w.strides), self.dense, self.touched)

    # --- What it does

    def fold(self, momentum: bool, forces: bool) -> None:
        kernels.fold(self._window.nodes, self.ghost, self._at, self.normal, self.wall_velocity, self.index,
                     self.weight, self.touched, self.contact.parity == "odd", momentum, forces, self._held)

    def fill(self, solved: bool, dt: float = 0.0) -> None:
        self._impulse[:] = 0.0
        kernels.fill(self._window.nodes, self.ghost, self._at, self.normal, self.wall_velocity, self.index,
                     self.weight, self.touched, self.contact.parity == "odd", solved, dt, self._held, self._impulse)
        if solved:
            self.impulse += self._impulse.sum(axis=0)

    def act(self, solved: bool, dt: float) -> None:
        nodes = self._window.nodes
        count = kernels.at_wall_velocities(
            nodes, self.at_wall, self._at, self.d, self.normal, self.index, self.weight, self._free, self._acting,
            self._share, self._stiffness, self._velocity, self._inner)
        if not count:
            return
        acting = self._acting[:count]
        before = self._velocity[:count].copy()
        normal = self.normal[acting]
        resist = (normal**2 * self._stiffness[:count]).sum(axis=1)
        mass = np.divide(1.0, resist, out=np.zeros(count), where=resist > 0)
        given = ContactNodes(
            position=self._x[acting], normal=normal, wall_velocity=self.wall_velocity[acting], mass=mass,
            velocity=self._velocity[:count], inner=self._inner[:count],
            depth=(self.d[acting] + 1) * self.grid.cell_size,
            touched=self.touched[self._at[acting]].astype(bool), memory=self.memory(acting))
        if solved:
            self.contact.solved(given, dt)
        else:
            self.contact.mapped(given)
        impulse = np.zeros((count, self.grid.dim))
        kernels.push(nodes, acting, self._at, self.normal, self.index, self._free, self._share, self._stiffness,
                     before, given.velocity, self.contact.parity == "odd", True, SWEEPS, solved, impulse)
        if solved:
            self.impulse += impulse.sum(axis=0)
        else:
            self.mapped_impulse += impulse.sum(axis=0)

    def memory(self, acting):
        return {}
