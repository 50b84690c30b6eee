"""A block of nodes or cells over the material, folded and filled at the faces of the domain and at walls."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...errors import PluginFault
from ...kernels import neighbours
from ...kernels.nodes import OPEN, PERIODIC
from ...kernels.vectors import LANES
from ...registry import audit
from ..grid import Grid, Span, Window
from ..walls import Room

LEAST_ROOM = 0.15
"""Crowding is computed only at nodes with at least this part of their volume in front of walls."""
LEAST_WEIGHT = 0.1
"""An image is used only if the nodes around it in front of all walls have at least this weight."""
PADDING = 2
"""Extra nodes at the end of the last axis, for vector loads of rows of pairs."""


def require_field(values: Any, count: int, of: str) -> None:
    """Raise PluginFault, of the plug-in that called, unless values are ``(count,)`` real numbers."""
    if not isinstance(values, np.ndarray) or values.shape != (count,) or values.dtype.kind not in "fiub":
        raise PluginFault(
            None,
            f"gave {audit.described(values)} as a field; it must have one number for each of {count} {of}",
        )


class Mirrored:
    """The block that a window covers, finer than the grid by the factor ``times``.

    Args:
        grid: its faces define the values behind them: the image at a wall, the other end of a period.
        window: the nodes that particles can touch, or the range that they span.
        times: nodes of the block per cell.
        centred: whether its points are cell centres instead of nodes.

    Attributes:
        room: area or volume of each node or cell, m² or m³, ``(count,)``; half as large at a wall.
    """

    def __init__(self, grid: Grid, window: Window | Span, times: int, centred: bool) -> None:
        self.grid = grid
        self.spacing = grid.cell_size / times
        self.lower = window.lower * times
        size = np.array(window.shape[: grid.dim])
        size[-1] -= PADDING
        size = (size - 1) * times + (0 if centred else 1)
        size[-1] += PADDING
        self.shape = tuple(int(n) for n in size)
        self.strides = (
            (self.shape[1] * self.shape[2], self.shape[2], 1) if grid.dim == 3 else (self.shape[1], 1, 1)
        )
        self.count = int(np.prod(size))
        self._ends = [
            (int(-low), int(n * times - low)) for low, n in zip(self.lower, grid.cells, strict=True)
        ]
        self.centred = centred
        self._ghosts = self._ghost_planes()
        self._whole = self.room = self._room()
        self._hidden = self._behind = self._blind = np.zeros(0, dtype=np.int64)
        self._image, self._weight = np.zeros((0, 1), dtype=np.int64), np.zeros((0, 1))

    def places(self) -> np.ndarray:
        """Positions of the nodes or cells in the scene, m, ``(count, dim)``."""
        index = np.indices(self.shape).reshape(self.grid.dim, -1).T + self.lower
        return self.grid.lower + (index + (0.5 if self.centred else 0.0)) * self.spacing

    def leave(self, room: Room) -> None:
        """Reduce the volume of each point by the part behind walls that are not faces.

        Values behind such a wall are mirrored as at a face. An image lies between nodes: the value behind the
        wall is distributed to the nodes around its image by linear weights, and their mean is filled back.
        """
        self._mirror(room)
        left = self._whole * room.part
        self._fold_walls(left)
        self._hidden = np.flatnonzero(left < LEAST_ROOM * self._whole)
        self.room = np.maximum(left, LEAST_ROOM * self._whole)

    def _mirror(self, room: Room) -> None:
        """Find the nodes around the image of each node behind a wall; nodes behind a wall get no weight."""
        dim = self.grid.dim
        behind = np.flatnonzero(room.behind)
        place = (room.image[behind] - self.grid.lower) / self.spacing - (0.5 if self.centred else 0.0)
        first = np.floor(place).astype(np.int64)
        corner = np.array(list(np.ndindex(*(2,) * dim)))
        number = first[:, None] + corner - self.lower
        part = (place - first)[:, None]
        weight = np.where(corner == 1, part, 1 - part).prod(axis=2)
        there = ((number >= 0) & (number < np.array(self.shape))).all(axis=2)
        index = np.where(there, number @ np.array(self.strides[:dim]), 0)
        weight *= there & ~room.behind[index]
        total = weight.sum(axis=1)
        seen = total > LEAST_WEIGHT
        self._behind, self._blind = behind[seen], behind[~seen]
        self._image, self._weight = index[seen], weight[seen] / total[seen, None]

    def _fold_walls(self, values: np.ndarray) -> None:
        """Distribute the values behind the walls to the nodes around their images, in place."""
        if len(self._behind):
            kept = values[self._behind]
            values[self._behind] = 0.0
            width = (1,) * (values.ndim - 1)
            np.add.at(values, self._image, self._weight.reshape(*self._weight.shape, *width) * kept[:, None])
        values[self._blind] = 0.0

    def _fill_walls(self, values: np.ndarray) -> None:
        """Set the values behind the walls to the mean of the nodes around their images, in place."""
        if len(self._behind):
            width = (1,) * (values.ndim - 1)
            weight = self._weight.reshape(*self._weight.shape, *width)
            values[self._behind] = (weight * values[self._image]).sum(axis=1)

    def crowded(self, sums: np.ndarray) -> np.ndarray:
        """Folded sums over the volumes, ``(count,)``; 1 if walls leave too little volume."""
        crowded = sums / self.room
        crowded[self._hidden] = 1.0
        return crowded

    def empty(self, width: int = 1) -> np.ndarray:
        """Zeros, ``(count, width)``, with extra memory at the end for a row of pairs."""
        return np.zeros(self.count * width + LANES)[: self.count * width].reshape(self.count, width)

    def field(self, values: np.ndarray) -> np.ndarray:
        """Values of the nodes, ``(count, 1)``, with extra memory at the end, for the kernels that gather."""
        require_field(values, self.count, "nodes or cells of the lattice")
        field = self.empty()
        field[:, 0] = values
        return field

    def fold(self, values: np.ndarray) -> None:
        """Add the values behind the faces and the walls to their images, in place, and set them to zero.

        Args:
            values: ``(count,)`` or ``(count, width)``.
        """
        block = self._block(values)
        for ghost, image in self._ghosts:
            block[image] += block[ghost]
            block[ghost] = 0.0
        self._fold_walls(values)

    def fill(self, values: np.ndarray) -> None:
        """Copy the images to the points behind the faces and the walls, in place."""
        self._fill_walls(values)
        block = self._block(values)
        for ghost, image in reversed(self._ghosts):
            block[ghost] = block[image]

    def _block(self, values: np.ndarray) -> np.ndarray:
        return values.reshape(*self.shape, *values.shape[1:])

    def _room(self) -> np.ndarray:
        room = np.full(self.shape, self.spacing**self.grid.dim)
        if not self.centred:
            for axis, (first, last) in enumerate(self._ends):
                along = np.moveaxis(room, axis, 0)
                for side, wall in enumerate((first, last)):
                    if self.grid.faces[axis, side] not in (OPEN, PERIODIC) and 0 <= wall < len(along):
                        along[wall] /= 2
        return room.ravel()

    def own(self) -> np.ndarray:
        """Which nodes or cells are in the domain, each once: no ghosts, no images, ``(count,)``."""
        own = np.zeros(self.shape, dtype=bool)
        ends = [
            (max(first, 0), last + (not self.centred and self.grid.faces[axis, 1] != PERIODIC))
            for axis, (first, last) in enumerate(self._ends)
        ]
        own[tuple(slice(first, max(first, end)) for first, end in ends)] = True
        return own.ravel()

    def least_around(self, values: np.ndarray) -> np.ndarray:
        """The minimum of each point and all its neighbours, corners included; 0 for points not stored."""
        return self._least(neighbours.least_around, values)

    def least_beside(self, values: np.ndarray) -> np.ndarray:
        """The minimum of each point and its neighbours along the axes."""
        return self._least(neighbours.least_beside, values)

    def _least(self, kernel: Callable[[np.ndarray, np.ndarray], None], values: np.ndarray) -> np.ndarray:
        block = np.ascontiguousarray(values, dtype=np.float64).reshape(self.shape[0], -1, self.shape[-1])
        least = np.empty_like(block)
        kernel(block, least)
        found = least.ravel()
        self.fill(found)
        return found

    def _ghost_planes(self) -> list[tuple[tuple, tuple]]:
        """Index of each plane behind the faces, with that of its image."""
        found = []
        for axis, (first, last) in enumerate(self._ends):
            for ghost, image in self._planes(axis, first, last):
                if 0 <= ghost < self.shape[axis] and 0 <= image < self.shape[axis]:
                    before = (slice(None),) * axis
                    found.append(((*before, ghost), (*before, image)))
        return found

    def _planes(self, axis: int, first: int, last: int) -> list[tuple[int, int]]:
        """Planes of ghosts of an axis and of their images; ``first`` and ``last`` are at its ends."""
        low, high = self.grid.faces[axis]
        if low == PERIODIC:
            ghosts = (first - 1, last) if self.centred else (first - 1, last, last + 1)
            return [(ghost, first + (ghost - first) % (last - first)) for ghost in ghosts]
        beside = 0 if self.centred else 1  # the cell at a wall is its own neighbour, a node has one
        planes = []
        if low != OPEN:
            planes.append((first - 1, first + beside))
        if high != OPEN:
            planes.append((last + beside, last - 1))
        return planes
