"""The nodes of the window that particles can reach; the others stay zero."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..kernels.nodes import OPEN, PERIODIC, PLANES
from ..kernels.scatter import NODE
from .grid import GHOST, Window
from .tasks import cuts


class Plane(NamedTuple):
    """Window indices, along an axis, of a plane of ghosts, the plane of their images, and the wall."""

    ghost: int
    image: int
    wall: int


class ActiveNodes:
    """Rows of nodes that the kernels process, and the ghosts and images among them.

    Attributes:
        mask: ``(nodes,)``, whether particles can touch each node of the window, or its image or ghost.
        rows: ``(n, 2)``, the first node and the one after the last of every row along the last axis.
        tasks: ``(TASKS + 1,)``, rows cut into pieces of about equal load.
        faces: ``(dim, 2)``, the codes of the faces.
        mirrors: ``(n, 3)``, ghost, image and wall node, plane by plane. Within a plane, all are different.
        plane_first: ``(3 dim + 1,)``, index of the first row of ``mirrors`` of each plane, and their number.
            The planes of an axis are the ghosts of its lower face, those of its upper face, and the upper
            face of a periodic axis, which is an image of the lower one.
        places: ``(n, dim)``, m, positions of the wall nodes of ``mirrors``; beyond a period, of the image.
        held: ``(n, NODE)``, scratch: values of the ghosts of ``mirrors`` before they were folded.
    """

    def __init__(self, window: Window, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> None:
        """
        Args:
            window: the nodes that are stored.
            lowest_cell: ``(n, dim)``, lower corner of boxes of cells that together contain all particles.
            highest_cell: ``(n, dim)``, upper corner of these boxes.
        """
        dim = window.grid.dim
        planes = [plane for axis in range(dim) for plane in _planes(window, axis)]
        touched = _touched(window, lowest_cell, highest_cell)
        for k, plane in enumerate(planes):
            _close(touched, k // PLANES, plane)
        self.rows = _rows(touched)
        self.mask = touched.ravel()
        self.tasks = cuts(np.concatenate([[0], np.cumsum(self.rows[:, 1] - self.rows[:, 0])]))
        self.faces = window.grid.faces
        mirrors = [_mirrors(window, touched, k // PLANES, plane) for k, plane in enumerate(planes)]
        self.mirrors = np.concatenate(mirrors)
        self.plane_first = np.concatenate([[0], np.cumsum([len(of_plane) for of_plane in mirrors])])
        self.places = _places(window, self.mirrors[:, 2])
        self.held = np.zeros((len(self.mirrors), NODE))
        self.arguments = (self.rows, self.tasks, self.faces, self.mirrors, self.plane_first)


def _touched(window: Window, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> np.ndarray:
    """Which nodes of the window can be touched by particles in these boxes of cells."""
    touched = np.zeros(window.shape[: window.grid.dim], dtype=bool)
    low, high = window.touchable(lowest_cell, highest_cell)
    for begin, end in zip(low - window.lower, high - window.lower + 1, strict=True):
        touched[tuple(map(slice, begin, end))] = True
    return touched


def _close(touched: np.ndarray, axis: int, plane: Plane | None) -> None:
    """Add the image of each touched ghost, and the ghost of each touched image, to fill ghosts later."""
    if plane is not None:
        along = np.moveaxis(touched, axis, 0)
        along[plane.ghost] |= along[plane.image]
        along[plane.image] = along[plane.ghost]


def _rows(touched: np.ndarray) -> np.ndarray:
    """First node, and the node after the last, of every row with touched nodes."""
    length = touched.shape[-1]
    row = np.flatnonzero(touched.any(axis=-1))
    touched = touched.reshape(-1, length)[row]
    first, behind = touched.argmax(axis=1), touched[:, ::-1].argmax(axis=1)
    return np.stack([row * length + first, (row + 1) * length - behind], axis=1)


def _mirrors(window: Window, touched: np.ndarray, axis: int, plane: Plane | None) -> np.ndarray:
    """(ghost, image, wall node) for the touched nodes of a plane."""
    if plane is None:
        return np.empty((0, 3), dtype=np.int64)
    index = np.moveaxis(np.arange(touched.size).reshape(touched.shape), axis, 0)
    ghosts = index[plane.ghost][np.moveaxis(touched, axis, 0)[plane.ghost]]
    return ghosts[:, None] + (np.array(plane) - plane.ghost) * window.strides[axis]


def _places(window: Window, nodes: np.ndarray) -> np.ndarray:
    """Positions of nodes of the window, m, ``(n, dim)``; beyond a period, those of their images."""
    grid = window.grid
    number = np.stack(np.unravel_index(nodes, window.shape[: grid.dim]), axis=1) + window.lower
    return grid.lower + np.where(grid.periodic, np.mod(number, grid.cells), number) * grid.cell_size


def _planes(window: Window, axis: int) -> Iterator[Plane | None]:
    """The ``PLANES`` planes of an axis; None for a plane that its faces do not have, or that is not stored.

    Planes are handled one after the other, because two may have the same image: along a periodic axis of one
    cell, the image of all three is the lower face.
    """
    lower, upper = (int(wall) for wall in window.walls[axis])
    of_face = [_behind(window, axis, 0, lower), _behind(window, axis, 1, upper)]
    if window.grid.faces[axis, 0] == PERIODIC:
        of_face.append(Plane(upper, lower, upper))
    else:
        of_face.append(None)
    for plane in of_face:
        stored = plane is not None and min(plane) >= 0 and max(plane) < window.shape[axis]
        yield plane if stored else None


def _behind(window: Window, axis: int, side: int, wall: int) -> Plane | None:
    """The ghosts behind a face."""
    face, inward = window.grid.faces[axis, side], 1 - 2 * side
    if face == OPEN:
        return None
    if face == PERIODIC:
        lower, ghost = int(window.walls[axis, 0]), wall - inward * GHOST
        return Plane(ghost, lower + (ghost - lower) % int(window.grid.cells[axis]), wall)
    return Plane(wall - inward, wall + inward, wall)
