"""The background grid: its lattice, its faces, and the window of nodes that follows the material."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..case.faces import Friction, Stick
from ..case.model import Case
from ..kernels import nodes as node_kernels
from ..kernels.scatter import CONTACT, NODE, PAIR
from ..kernels.vectors import LANES
from .stateful import State

FACE_CODES = {
    "open": node_kernels.OPEN,
    "slip": node_kernels.FRICTION,
    "symmetry": node_kernels.MIRROR,
    "stick": node_kernels.STICK,
    "periodic": node_kernels.PERIODIC,
}
KEPT = (0, CONTACT)
"""Entries of a node's record (mass and contact) that are read before a step overwrites them: by the mass
guard and by walls."""
GHOST = 1
"""Layers of nodes beyond each face that the widest particle at a face can touch."""


@dataclass
class Grid:
    """Cubic cells on a box. Node 0 of an axis is on its lower face, node -1 outside.

    Attributes:
        lower: lower corner of the domain, m, ``(dim,)``.
        cells: number of cells along each axis, ``(dim,)``.
        cell_size: side of a cell, m.
        faces: code of each face, lower and upper, see ``kernels.nodes``, ``(dim, 2)``.
        friction: friction coefficient of each face, ``(dim, 2)``.
        axes: names of the axes.
        radial: whether axis 0 is the radius of an axisymmetric scene.
    """

    lower: np.ndarray
    cells: np.ndarray
    cell_size: float
    faces: np.ndarray
    friction: np.ndarray
    axes: tuple[str, ...]
    radial: bool = False

    @classmethod
    def of(cls, case: Case) -> Grid:
        space, spec = case.space_, case.grid
        ends = np.array([spec.domain[axis] for axis in space.axes])
        faces = np.full((space.dim, 2), node_kernels.OPEN)
        friction = np.zeros((space.dim, 2))
        for index, name in enumerate(space.faces):
            face = spec.faces.get(name, "open")
            if isinstance(face, Friction):
                faces.flat[index] = node_kernels.FRICTION
                friction.flat[index] = face.coefficient
            elif isinstance(face, Stick):
                faces.flat[index] = node_kernels.RELEASING_STICK if face.releases else node_kernels.STICK
            else:
                faces.flat[index] = FACE_CODES[face]
        if space.radial:
            faces[0, 0] = node_kernels.MIRROR
        cells = np.rint((ends[:, 1] - ends[:, 0]) / spec.cell_size).astype(np.int64)
        return cls(ends[:, 0], cells, spec.cell_size, faces, friction, space.axes, space.radial)

    @cached_property
    def dim(self) -> int:
        return len(self.cells)

    @cached_property
    def extent(self) -> np.ndarray:
        """Lengths of the domain, m."""
        return self.cells * self.cell_size

    @property
    def nodes(self) -> tuple[int, ...]:
        """Nodes along each axis, ghosts included."""
        return tuple(int(n) + 1 + 2 * GHOST for n in self.cells)

    @cached_property
    def walls(self) -> np.ndarray:
        """Faces that act only where material touches them, ``(dim, 2)``; without planes of symmetry."""
        return np.array([[node_kernels.is_wall(face) for face in pair] for pair in self.faces])

    @cached_property
    def walled(self) -> bool:
        """Whether there is any wall."""
        return bool(self.walls.any())

    @property
    def periodic(self) -> np.ndarray:
        return self.faces[:, 0] == node_kernels.PERIODIC


class Span(NamedTuple):
    """The nodes that a block covers."""

    lower: np.ndarray
    """(dim,) number of its first node along each axis"""
    shape: tuple[int, int, int]
    """nodes along each axis"""


@dataclass
class Window:
    """The block of nodes that is stored: the bounding box of the material, plus a margin for its motion.

    Cost and memory depend on the material, not on the domain. ``shape`` and ``strides`` have three entries,
    so that kernels on nodes work for any dimension.
    """

    grid: Grid
    lower: np.ndarray = field(init=False)
    shape: tuple[int, int, int] = field(init=False)
    strides: tuple[int, int, int] = field(init=False)
    walls: np.ndarray = field(init=False)
    nodes: np.ndarray = field(init=False)
    """Records of ``NODE`` doubles, one a node."""
    pairs: np.ndarray = field(init=False)
    """(nodes, 2) the sums of an average; zero outside averaging"""
    average: np.ndarray = field(init=False)
    """(nodes, 1) the average itself"""
    _cells: tuple[np.ndarray, np.ndarray] | None = field(init=False, default=None)
    """Lowest and highest cell for which the window was laid; None before the first time."""
    _capacity: int = field(init=False, default=0)
    _stores: list[np.ndarray] = field(init=False)

    def touchable(self, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First and last node along each axis that particles in these cells, ``(..., dim)``, can touch.

        A particle's box reaches at most half a cell beyond its own cell. If the image of a ghost
        is included, so is the ghost, so that folded values can be filled back.
        """
        grid = self.grid
        low, high = lowest_cell - 1, highest_cell + 2
        low = np.where(grid.periodic | (low <= GHOST), -GHOST, low)
        high = np.where(grid.periodic | (high >= grid.cells - GHOST), grid.cells + GHOST, high)
        return low, high

    def span(self, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> Span:
        """Number of nodes that a block needs for particles in these cells, ``(dim,)``."""
        low, high = self.touchable(lowest_cell, highest_cell)
        return Span(low.astype(np.int64), self._shape(low, high))

    def cover(self, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> None:
        """Lay the window over the nodes that particles in these cells can touch; all are zero."""
        contacts = self._contacts()
        self._lay(lowest_cell, highest_cell)
        if contacts is not None:
            self._restore_contacts(*contacts)

    def state(self) -> State:
        """Position of the window, and the masses and contacts of its nodes, which outlive a step."""
        if self._cells is None:
            return {}
        low, high = self._cells
        return {"low": low, "high": high, "kept": self.nodes[:, list(KEPT)]}

    def restore(self, state: State) -> None:
        """Lay the window at its saved position, in new memory."""
        self._capacity, self._cells = 0, None
        if state:
            self._lay(state["low"].copy(), state["high"].copy())
            self.nodes[:, list(KEPT)] = state["kept"]

    def _lay(self, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> None:
        grid = self.grid
        self._cells = lowest_cell, highest_cell
        self.lower, self.shape = self.span(lowest_cell, highest_cell)
        self.strides = (self.shape[1] * self.shape[2], self.shape[2], 1)
        self.walls = np.stack([-self.lower, grid.cells - self.lower], axis=1)
        count = math.prod(self.shape)
        if count > self._capacity:
            self._capacity = count + count // 4
            self._stores = [_aligned(self._capacity * width + LANES) for width in (NODE, PAIR, 1)]
        self.nodes, self.pairs, self.average = (
            store[: count * width].reshape(count, width)
            for store, width in zip(self._stores, (NODE, PAIR, 1), strict=True)
        )
        self.nodes[:] = 0.0
        self.average[:] = 0.0

    def _shape(self, low: np.ndarray, high: np.ndarray) -> tuple[int, int, int]:
        """Nodes along each of three axes of a window over touched nodes; 1 along a missing axis."""
        # One more node, with zero weight: a particle on an upper face belongs to the cell beyond it, and the
        # last node in the table of its shape function has no weight.
        size = [int(n) + 1 for n in high - low + 1]
        size[-1] += 1  # vector loads of rows of pairs read one node further
        size += [1] * (3 - self.grid.dim)
        return size[0], size[1], size[2]

    def missing(self, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> int:
        """Nodes that the window over these cells needs; 0 if its present memory is large enough."""
        count = math.prod(self.span(lowest_cell, highest_cell).shape)
        return count if count > self._capacity else 0

    def _contacts(self) -> tuple[np.ndarray, np.ndarray] | None:
        """The nodes that walls pushed last, and the block's lower corner: the data that outlive a window."""
        if self._cells is None or not self.grid.walled:
            return None
        return self.lower, self.nodes[:, CONTACT].reshape(self.shape[: self.grid.dim]).copy()

    def _restore_contacts(self, lower: np.ndarray, contacts: np.ndarray) -> None:
        low = np.maximum(lower, self.lower)
        high = np.minimum(lower + contacts.shape, self.lower + self.shape[: self.grid.dim])
        if (low < high).all():
            new = self.nodes[:, CONTACT].reshape(self.shape[: self.grid.dim])
            common = [tuple(map(slice, low - start, high - start)) for start in (lower, self.lower)]
            new[common[1]] = contacts[common[0]]


def _aligned(size: int) -> np.ndarray:
    """Zeros aligned to cache lines, so that the record of a node lies in one line."""
    line = 8 * LANES
    store = np.zeros(size + LANES)
    begin = -store.ctypes.data % line // 8
    return store[begin : begin + size]
