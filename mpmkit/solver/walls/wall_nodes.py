"""The nodes near a wall: at it, behind it, and around their images."""

from __future__ import annotations

import numpy as np

from ...case.walls import OVER
from ...contracts import Contact
from ...contracts.contact import initial_memory
from ...kernels import ghosts, wall_contact, wall_nodes, wall_reach
from ...kernels.nodes import OPEN, PERIODIC
from ...kernels.scatter import CONTACT, PUSHED, TOUCHED
from ...registry import audit
from ..grid import Grid, Window

LAG = 0.02
"""Cells that a wall may move before its nodes are classified again; its velocity is always current."""
UP = 2.0
"""Distance from a face, in cells, at which the side of a wall that stands on the face is evaluated."""
STANDS = 1e-3
"""Largest distance from a face, in cells, of a point of a wall that counts as on the face."""
FACING = 0.9
"""A wall and a face of the grid are opposite if minus the cosine of the angle between their normals exceeds
this."""
MARGIN = 1.0
"""Cells that a wall may move before the nodes near it are searched again."""


class WallNodes:
    """The nodes of one window near one wall, and their data. Lengths are in cells, positions in m."""

    def __init__(self, contact: Contact, grid: Grid, window: Window, active: np.ndarray) -> None:
        """
        Args:
            contact: the contact, for its memory.
            grid, window: the nodes.
            active: (nodes,) of the window, whether particles can reach a node, uint8.
        """
        dim = grid.dim
        self.grid, self.window, self.active = grid, window, active
        self.contact = contact
        self.lower, self.shape = window.lower, np.array(window.shape)
        self.strides = np.array(window.strides)
        number = np.indices(window.shape[:dim]).reshape(dim, -1).T + window.lower
        self.numbers = np.ascontiguousarray(number)
        # For nodes behind a plane of symmetry or beyond a period, use the position of the image.
        places = np.where(grid.periodic, np.mod(number, grid.cells), number)
        if grid.radial:
            places[:, 0] = np.abs(places[:, 0])
        self.places = grid.lower + places * grid.cell_size
        self.faces = _faces_at(grid, number)
        self.sides = (number == grid.cells).astype(np.uint8)
        self._inside = active * _in_front_of_faces(grid, number)
        self.free = np.zeros(len(active), dtype=np.int64)
        count = len(active)
        self.dense = np.full(count, wall_nodes.FAR)
        self.touched = np.zeros(count, dtype=np.uint8)
        self._pressed = np.zeros(count)
        self._taken = np.zeros(count, dtype=np.uint8)
        self.memory = initial_memory(contact, count)
        self._at_start = initial_memory(contact, 1)
        self.found = self.sorted = False

    def take_memory(self, before: WallNodes) -> None:
        """The memory of the contact at nodes that were in the window before."""
        low = np.maximum(before.lower, self.lower)
        shapes = [layout.window_shape for layout in (before, self)]
        high = np.minimum(before.lower + shapes[0], self.lower + shapes[1])
        if (low < high).all():
            common = [tuple(map(slice, low - layout.lower, high - layout.lower)) for layout in (before, self)]
            for name, array in self.memory.items():
                array.reshape(shapes[1])[common[1]] = before.memory[name].reshape(shapes[0])[common[0]]

    @property
    def window_shape(self) -> np.ndarray:
        return self.shape[: self.grid.dim]

    def find(self, surface: audit.AuditedSurface, time: float) -> None:
        """Find the nodes that are, or may soon be, near the surface."""
        dim = self.grid.dim
        distance, _ = surface.distance(self.places, time)
        near = np.abs(distance) <= (wall_reach.NEAR + MARGIN) * self.grid.cell_size
        self.at = np.flatnonzero(near & (self.active > 0))
        k = len(self.at)
        self.number = np.ascontiguousarray(self.numbers[self.at])
        self.place = np.ascontiguousarray(self.places[self.at])
        self._at_wall, self._ghosts, self._behind, self.acting = np.empty((4, k), dtype=np.int64)
        self.index, self.image, self.foot = np.zeros((3, k, 1 << dim), dtype=np.int64)
        self.weight, self.image_weight, self.foot_weight = np.zeros((3, k, 1 << dim))
        self.share = np.zeros((k, 1 + (1 << dim)))
        self.held = np.zeros((k, 1 + 2 * dim))
        self.pair = np.zeros((k, 2))
        self.inverse_mass, self.velocity, self.inner, self.given, self.impulse, self.mapped = np.zeros(
            (6, k, dim)
        )
        self.held_at = np.zeros(k, dtype=np.uint8)
        self.dense[:] = wall_nodes.FAR
        self.found, self.sorted = True, False

    def sort(self, surface: audit.AuditedSurface, time: float) -> None:
        """Find the nodes at the wall, the ghosts, and the nodes around the image of each ghost."""
        distance, self.normal = self._clear_of_faces(surface, time, *surface.distance(self.place, time))
        if self.grid.radial:  # a node behind the axis sees the image of the wall
            self.normal[self.number[:, 0] < 0, 0] *= -1.0
        self.speed(surface, time)
        self.d = distance / self.grid.cell_size
        self.dense[self.at] = self.d
        self._taken[:] = 0
        of_window = (self.lower, self.shape, self.strides, self.active, self._inside, self._taken)
        count, ghosts = wall_nodes.find_nodes(
            self.at, self.number, self.d, self.normal, *of_window, self._at_wall, self._ghosts, self.index,
            self.weight, self.foot, self.foot_weight,
        )  # fmt: skip
        behind = wall_nodes.find_images(
            self.at, self.number, self.d, self.normal, *of_window, self._behind, self.image, self.image_weight
        )
        self.at_wall, self.ghosts = self._at_wall[:count], self._ghosts[:ghosts]
        self.behind = self._behind[:behind]
        self._find_covered()
        self.sorted = True

    def _clear_of_faces(
        self, surface: audit.AuditedSurface, time: float, distance: np.ndarray, normal: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Distances and normals, without the part of a wall that lies on a face of the grid.

        There is no material between the two: a node there is behind the side of the wall. For this node, the
        side at ``UP`` cells from the face is extended to the face as a plane.
        """
        grid, distance, normal = self.grid, distance.copy(), normal.copy()
        up = UP * grid.cell_size
        for axis, side in zip(*np.nonzero(grid.walls), strict=True):
            inward, plane = (
                (1.0, grid.lower[axis]) if side == 0 else (-1.0, grid.lower[axis] + grid.extent[axis])
            )
            foot = self.place[:, axis] - distance * normal[:, axis]
            stands = np.abs(foot - plane) < STANDS * grid.cell_size
            on = np.flatnonzero(stands & (normal[:, axis] * inward < -FACING))
            if not len(on):
                continue
            place = self.place[on].copy()
            place[:, axis] += inward * up
            away, direction = surface.distance(place, time)
            seen = direction[:, axis] * inward >= -FACING
            distance[on[seen]] = (away - inward * up * direction[:, axis])[seen]
            normal[on[seen]] = direction[seen]
        return distance, normal

    def _find_covered(self) -> None:
        """Find the nodes on faces of the grid that the wall covers: it is in front of them, or on them."""
        index, bits = [np.zeros(0, dtype=np.int64)], [np.zeros(0, dtype=np.int64)]
        for axis in range(self.grid.dim):
            for side, inward in enumerate((1.0, -1.0)):
                on_face = self.number[:, axis] == (0 if side == 0 else self.grid.cells[axis])
                over = on_face & (self.d <= wall_reach.TOUCH) & (self.normal[:, axis] * inward > OVER)
                index.append(self.at[over])
                bits.append(np.full(int(over.sum()), (TOUCHED | PUSHED) << axis))
        self.covered, self._covered_bits = np.concatenate(index), np.concatenate(bits)

    def take_from_faces(self) -> None:
        """Release the nodes that the wall covers from the faces: there, the material touches the wall."""
        if len(self.covered):
            contact = self.window.nodes[self.covered, CONTACT].astype(np.int64)
            self.window.nodes[self.covered, CONTACT] = contact & ~self._covered_bits

    def pressed(self, acting: np.ndarray, dt: float) -> np.ndarray:
        """Normal impulse of ghosts on nodes at the wall, N s; negative if it pulls."""
        ghosts.press(self.ghosts, self.normal, self.foot, self.foot_weight, self.held, dt, self._pressed)
        found = self._pressed[self.at[acting]]
        self._pressed[self.at] = 0.0
        return found

    def speed(self, surface: audit.AuditedSurface, time: float) -> None:
        """Set the velocity of the wall to that at a time, s."""
        self.wall_velocity = surface.velocity(self.place, time)
        if self.grid.radial:
            self.wall_velocity[self.number[:, 0] < 0, 0] *= -1.0

    def see_faces(self) -> None:
        """Find the axes along which no face of the grid holds a node, in the present state of the nodes."""
        wall_contact.find_free_axes(self.window.nodes, self.at, self.faces, self.grid.dim, self.free)

    def remember(self, acting: np.ndarray, memory: dict[str, np.ndarray]) -> None:
        """Save the memory of a contact; nodes at which it does not act lose it."""
        self.forget()
        for name, array in self.memory.items():
            array[self.at[acting]] = memory[name]

    def forget(self) -> None:
        """Delete the memory of the contact at the nodes near the wall."""
        for name, array in self.memory.items():
            array[self.at] = self._at_start[name]


def _faces_at(grid: Grid, number: np.ndarray) -> np.ndarray:
    """The codes of the faces on which nodes lie, ``(n, dim)``; the code of an open face elsewhere."""
    faces = np.full(number.shape, OPEN)
    for axis in range(grid.dim):
        for side, plane in enumerate((0, int(grid.cells[axis]))):
            faces[number[:, axis] == plane, axis] = grid.faces[axis, side]
    return faces


def _in_front_of_faces(grid: Grid, number: np.ndarray) -> np.ndarray:
    """Whether nodes are in the domain, or beyond a face that mirrors nothing, ``(n,)``, uint8."""
    inside = np.ones(len(number), dtype=np.uint8)
    for axis in range(grid.dim):
        low, high = grid.faces[axis]
        if low not in (OPEN, PERIODIC):
            inside[number[:, axis] < 0] = 0
        if high not in (OPEN, PERIODIC):
            inside[number[:, axis] > grid.cells[axis]] = 0
    return inside
