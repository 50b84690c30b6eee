"""The nodes of the window that particles can reach; the others stay zero."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..kernels.nodes import OPEN, PERIODIC
from .grid import GHOST, Window
from .tasks import cuts


class ActiveNodes:
    """Rows of nodes to go through, and the ghosts and images among them.

    Attributes:
        rows: ``(n, 2)``, the first node and the one after the last of every row along the last axis.
        tasks: ``(TASKS + 1,)``, rows cut into pieces of about equal load.
        faces: ``(dim, 2)``, the codes of the faces.
        mirrors: ``(n, 3)``, ghost, image and node of the wall, face by face.
        face_first: ``(2 dim + 1,)``, the first of ``mirrors`` of each face, and their number.
    """

    def __init__(self, window: Window, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> None:
        """
        Args:
            window: the nodes that are stored.
            lowest_cell: ``(n, dim)``, of boxes of cells, in one of which every particle is.
            highest_cell: the same at their other end.
        """
        dim = window.grid.dim
        planes = [list(_planes(window, axis, side)) for axis in range(dim) for side in range(2)]
        touched = _touched(window, lowest_cell, highest_cell)
        for face, of_face in enumerate(planes):
            _close(touched, face // 2, of_face)
        self.rows = _rows(touched)
        self.tasks = cuts(np.concatenate([[0], np.cumsum(self.rows[:, 1] - self.rows[:, 0])]))
        self.faces = window.grid.faces
        mirrors = [_mirrors(window, touched, face // 2, of_face) for face, of_face in enumerate(planes)]
        self.mirrors = np.concatenate(mirrors)
        self.face_first = np.concatenate([[0], np.cumsum([len(of_face) for of_face in mirrors])])
        self.arguments = (self.rows, self.tasks, self.faces, self.mirrors, self.face_first)


def _touched(window: Window, lowest_cell: np.ndarray, highest_cell: np.ndarray) -> np.ndarray:
    """Which nodes of the window particles in these boxes of cells can touch."""
    touched = np.zeros(window.shape[: window.grid.dim], dtype=bool)
    low, high = window.touchable(lowest_cell, highest_cell)
    for begin, end in zip(low - window.lower, high - window.lower + 1, strict=True):
        touched[tuple(map(slice, begin, end))] = True
    return touched


def _close(touched: np.ndarray, axis: int, planes: list[tuple[int, int, int]]) -> None:
    """With a ghost its image, and with an image its ghost: what is folded can be filled back."""
    along = np.moveaxis(touched, axis, 0)
    for ghost, image, _ in planes:
        along[ghost] |= along[image]
        along[image] = along[ghost]


def _rows(touched: np.ndarray) -> np.ndarray:
    """First node and the one after the last of every row in which any node is touched."""
    length = touched.shape[-1]
    row = np.flatnonzero(touched.any(axis=-1))
    touched = touched.reshape(-1, length)[row]
    first, behind = touched.argmax(axis=1), touched[:, ::-1].argmax(axis=1)
    return np.stack([row * length + first, (row + 1) * length - behind], axis=1)


def _mirrors(
    window: Window, touched: np.ndarray, axis: int, planes: list[tuple[int, int, int]]
) -> np.ndarray:
    """(ghost, image, node of the wall) of all nodes behind a face that are touched."""
    found = [np.empty((0, 3), dtype=np.int64)]
    index = np.moveaxis(np.arange(touched.size).reshape(touched.shape), axis, 0)
    for plane in planes:
        ghosts = index[plane[0]][np.moveaxis(touched, axis, 0)[plane[0]]]
        found.append(ghosts[:, None] + (np.array(plane) - plane[0]) * window.strides[axis])
    return np.concatenate(found)


def _planes(window: Window, axis: int, side: int) -> Iterator[tuple[int, int, int]]:
    """Planes of ghosts of a face within the window, each with that of their images and with the wall's."""
    face, inward = window.grid.faces[axis, side], 1 - 2 * side
    lower, wall = int(window.walls[axis, 0]), int(window.walls[axis, side])
    pairs = []
    if face == PERIODIC:  # the upper wall is an image of the lower one
        ghosts = (wall - inward * GHOST, wall)[: 1 + side]
        pairs = [(ghost, lower + (ghost - lower) % int(window.grid.cells[axis])) for ghost in ghosts]
    elif face != OPEN:
        pairs = [(wall - inward, wall + inward)]
    for ghost, image in pairs:
        if min(ghost, image) >= 0 and max(ghost, image) < window.shape[axis]:
            yield ghost, image, wall
