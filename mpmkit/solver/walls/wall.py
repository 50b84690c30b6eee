"""A wall of a scene, or a part of one: the nodes at which it acts, and its impulses on the material."""

from __future__ import annotations

import numpy as np

from ...contracts import Contact, ContactNodes
from ...kernels import ghosts, wall_contact, wall_reach
from ...registry import audit
from ..grid import Grid, Window
from ..stateful import State, plain_state, restore_plain
from .wall_nodes import LAG, MARGIN, WallNodes

SWEEPS = 3
"""Sweeps, alternately forwards and backwards, that couple the impulses at neighbouring nodes. The number is
odd, so that the sequence is symmetric."""


class Wall:
    """A surface with a contact, on the nodes of a window. Lengths are in cells, positions in m.

    Attributes:
        touches: how many particles touch it in this step.
        sums: sums of the action on the material so far: impulse, N s, ``(dim,)``, its moment about the
            origin of the scene, N m s, ``(3,)`` or ``(1,)`` about the axis out of the plane, and work, J.
    """

    def __init__(self, surface: audit.AuditedSurface, contact: Contact, grid: Grid) -> None:
        self.surface = surface
        self.contact = contact
        self.grid = grid
        self.odd = contact.parity == "odd"
        self.pulls = contact.pulls
        self.sums = np.zeros(grid.dim + (3 if grid.dim == 3 else 1) + 1)
        self._mapped = np.zeros(len(self.sums))
        self._found = self._sorted = self._time = self._moved = self._lag = 0.0
        self._there = self.changes = False
        self.touches = 0
        self._near: WallNodes | None = None
        self._acting, self._after = np.zeros(0, dtype=np.int64), np.zeros((0, grid.dim))

    @property
    def near(self) -> WallNodes:
        """The nodes near it."""
        assert self._near is not None
        return self._near

    @property
    def is_near(self) -> bool:
        """Whether any node that particles can reach is near it; other walls cost nothing in a step."""
        return len(self.near.at) > 0

    def state(self) -> State:
        """Its sums, its last searched position, and the memory of its contact at the nodes."""
        kept = plain_state(self, but=("odd", "pulls", "_near", "_acting", "_after"))
        if self._near is not None:
            kept |= {f"memory/{name}": array for name, array in self._near.memory.items()}
        return kept

    def restore(self, state: State) -> None:
        """Restore a state; call ``lay`` afterwards."""
        restore_plain(self, state)
        self._near = None

    # --- Where it is

    def lay(self, window: Window, active: np.ndarray, state: State | None = None) -> None:
        """Switch to a new window, or back to one in which the wall had a state."""
        before, self._near = self._near, WallNodes(self.contact, self.grid, window, active)
        self._acting, self._after = np.zeros(0, dtype=np.int64), np.zeros((0, self.grid.dim))
        if state is not None:
            for name, array in self._near.memory.items():
                array[...] = state[f"memory/{name}"]
            self._find(self._found)
            lag = self._lag
            self._sort(self._sorted)
            self._lag = lag
            self.near.speed(self.surface, self._time)
        elif before is not None:
            self._near.take_memory(before)

    def move_to(self, time: float) -> None:
        """Move to the position at a time, s."""
        there, self._there = self._there, self.surface.present(time)
        moved = self.surface.fastest(self._time, time) * (time - self._time) / self.grid.cell_size
        self._moved += moved
        self._lag += moved
        if not self.near.found or self._moved > MARGIN:
            self._find(time)
            self._moved = 0.0
        if not self.near.sorted or (self._lag > LAG and self.is_near):
            self._sort(time)
        elif moved > 0 and self.is_near:
            self.near.speed(self.surface, time)
        self.changes = self.changes or moved > 0 or (self._found < time and there != self._there)
        self._time = time

    def _find(self, time: float) -> None:
        self._found = time
        self.near.find(self.surface, time)

    def _sort(self, time: float) -> None:
        self._sorted, self._lag = time, 0.0
        self.near.sort(self.surface, time)

    def seen_from(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """Distance, m, ``(n,)``, and normal, ``(n, dim)``, of its last position at points, m; None if it is
        not present."""
        return self.surface.distance(places, self._time) if self._there else None

    # --- What it does

    def keep_out(self, position: np.ndarray) -> None:
        """Move particles inside the wall back to its surface."""
        if self._there and self.is_near:
            w = self.near
            wall_reach.keep_out(position, self.grid.cell_size, w.lower, w.strides, w.dense)

    def mark(self, position: np.ndarray, half_size: np.ndarray, base: np.ndarray, weight: np.ndarray) -> None:
        """Find the nodes that material touches, by the boxes of the particles and their weights."""
        w = self.near
        before, self.touches = self.touches, 0
        self._mapped[:] = 0.0
        w.touched[w.at] = 0
        if self._there and self.is_near:
            self.touches = wall_reach.mark_touched(
                position, half_size, 1 / self.grid.cell_size, base, weight, w.lower, w.strides, w.dense,
                w.touched,
            )  # fmt: skip
        if self.touches:
            w.take_from_faces()
        elif before:
            w.forget()

    def fold(self, momentum: bool, forces: bool) -> None:
        """Fold the values on its ghosts."""
        if not self.touches:
            return
        w = self.near
        ghosts.fold(
            w.window.nodes, w.ghosts, w.at, w.normal, w.wall_velocity, w.index, w.weight, w.touched, self.odd,
            momentum, forces, w.held,
        )  # fmt: skip

    def act(self, rehearse: bool, dt: float | None) -> None:
        """Apply the contact to the velocities after mapping, or after the momentum equation in a step of
        ``dt`` s.

        Other walls may push the same nodes: ``sweep`` and ``count`` follow.
        """
        w = self.near
        w.see_faces()
        count = wall_contact.at_wall_velocities(
            w.window.nodes, w.at_wall, w.at, w.d, w.normal, w.index, w.weight, w.free, w.acting, w.share,
            w.inverse_mass, w.velocity, w.inner,
        )  # fmt: skip
        self._acting = w.acting[:count]
        self._after = w.velocity[:count]
        if not count:
            return
        before = self._after.copy()
        nodes = self._given(count, dt)
        if rehearse:
            audit.rehearse_contact(self.contact, nodes, dt)
        audit.call_contact(self.contact, nodes, dt)
        w.remember(self._acting, nodes.memory)
        self._give(before, self._after, dt is not None)

    def sweep(self, backwards: bool, solved: bool) -> None:
        """Restore the contact velocities at its nodes after other walls have pushed them."""
        self._sweep(self._after, backwards, solved)

    def count(self, solved: bool, of_faces: np.ndarray) -> None:
        """Sum up its impulses at the nodes.

        ``of_faces`` gets the impulses of the faces of the grid at nodes that they hold against it.
        """
        w, sums = self.near, self.sums
        if not solved:
            sums = self._mapped
            sums[:] = 0.0
        impulse = w.given[: len(self._acting)]
        self._add_up(impulse, self._acting, sums)
        wall_contact.add_up_held(
            impulse, w.window.nodes, self._acting, w.at, w.index, w.share, w.free, w.faces, w.sides, w.places,
            of_faces,
        )  # fmt: skip

    def _give(self, before: np.ndarray, after: np.ndarray, solved: bool) -> None:
        w = self.near
        wall_contact.give(
            w.window.nodes, self._acting, w.at, w.normal, w.index, w.free, w.share, w.inverse_mass,
            before, after, solved, w.given, w.held_at,
        )  # fmt: skip

    def _sweep(self, after: np.ndarray, backwards: bool, solved: bool) -> None:
        w = self.near
        pulls = self.pulls or not solved  # nodes in contact are held until the next decision
        wall_contact.sweep(
            w.window.nodes, self._acting, w.at, w.normal, w.index, w.free, w.share, w.inverse_mass,
            after, self.odd, pulls, backwards, solved, w.given, w.held_at,
        )  # fmt: skip

    def _shared(self, acting: np.ndarray, velocity: np.ndarray, touched: np.ndarray) -> np.ndarray:
        """Contribution of neighbours to the impulse at each point, N s, ``(k,)``: they push the same nodes.

        It is found by a trial; the nodes are restored afterwards.
        """
        w, normal = self.near, self.near.normal[acting]
        rows = np.unique(np.concatenate([w.at[acting], w.index[acting].ravel()]))
        nodes = w.window.nodes
        kept = nodes[rows]
        away = np.where(
            touched, np.minimum(((velocity - w.wall_velocity[acting]) * normal).sum(axis=1), 0.0), 0.0
        )
        after = velocity - away[:, None] * normal
        self._give(velocity, after, True)
        for turn in range(SWEEPS):
            self._sweep(after, turn % 2 == 0, True)
        impulse = self.near.given[: len(acting)].copy()
        nodes[rows] = kept
        inverse_mass = self._inverse_mass_along_normal(acting)
        alone = np.divide(-away, inverse_mass, out=np.zeros(len(acting)), where=inverse_mass > 0)
        return (impulse * normal).sum(axis=1) - alone

    def _pressed(self, acting: np.ndarray, touched: np.ndarray, dt: float | None) -> np.ndarray:
        """Impulse, N s, ``(k,)``, from the mirrored material behind the wall, and from neighbours."""
        if dt is None or not self.contact.counts_push:
            return np.zeros(len(acting))
        velocity = self.near.velocity[: len(acting)]
        return self.near.pressed(acting, dt) + self._shared(acting, velocity, touched)

    def _inverse_mass_along_normal(self, acting: np.ndarray) -> np.ndarray:
        """Change of the normal velocity of the material per normal impulse at each point, 1/kg, ``(k,)``."""
        normal = self.near.normal[acting]
        return (normal * normal * self.near.inverse_mass[: len(acting)]).sum(axis=1)

    def _given(self, count: int, dt: float | None) -> ContactNodes:
        w = self.near
        acting = w.acting[:count]
        inverse_mass = self._inverse_mass_along_normal(acting)
        mass = np.divide(1.0, inverse_mass, out=np.zeros(count), where=inverse_mass > 0)
        at = w.at[acting]
        touched = w.touched[at] > 0
        return ContactNodes(
            position=w.place[acting],
            normal=w.normal[acting],
            wall_velocity=w.wall_velocity[acting],
            mass=mass,
            velocity=w.velocity[:count],
            inner=w.inner[:count],
            depth=(w.d[acting] + 1) * self.grid.cell_size,
            pressed=self._pressed(acting, touched, dt) * inverse_mass,
            touched=touched,
            memory={name: array[at] for name, array in w.memory.items()},
            time=self._time,
        )

    def fill(self, dt: float | None) -> None:
        """Fill its ghosts with velocities after mapping, or after the momentum equation (step ``dt``)."""
        if not self.touches:
            return
        w = self.near
        ghosts.fill(
            w.window.nodes, w.ghosts, w.at, w.normal, w.wall_velocity, w.index, w.weight, w.touched, self.odd,
            dt is not None, dt or 0.0, w.held, w.impulse, w.mapped,
        )  # fmt: skip
        if dt is not None:
            self._add_up(w.impulse[w.ghosts], w.ghosts, self.sums)
            self._add_up(w.mapped[w.ghosts], w.ghosts, self._mapped)

    def _add_up(self, impulse: np.ndarray, nodes: np.ndarray, sums: np.ndarray) -> None:
        w = self.near
        depth = w.d * self.grid.cell_size
        wall_contact.add_up(impulse, nodes, w.place, depth, w.normal, w.wall_velocity, sums)

    def taken_up(self, part: float) -> None:
        """Count the part of the impulses in mapping that reaches the particles."""
        self.sums += part * self._mapped
