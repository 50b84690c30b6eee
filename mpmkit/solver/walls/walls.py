"""All walls of a scene that are not faces of its grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...case.model import Case
from ...kernels import ghosts
from ...kernels import nodes as node_kernels
from ...kernels.splines import below_surface
from ...registry import audit
from ..grid import Grid, Window
from ..particles import Particles
from ..sorting import Sorting
from ..stateful import State, Stateful, plain_state, restore, restore_plain, state_of
from .wall import SWEEPS, Wall


@dataclass(frozen=True)
class Room:
    """Part of the volume of points that is not behind walls."""

    part: np.ndarray
    """Part of the volume of each point, ``(n,)``."""
    behind: np.ndarray
    """Whether each is behind a wall, ``(n,)``."""
    image: np.ndarray
    """Mirror image in that wall, m, ``(n, dim)``; the point itself if it is in front of all walls."""


class Walls:
    """Applies each wall when a step constrains nodes: after mapping, and after the momentum equation.

    Walls fold one after the other and fill in the opposite order, after the faces of the grid have folded and
    before they fill for the last time, so that all of it together is a fold and its transpose.
    """

    def __init__(self, case: Case, grid: Grid, window: Window, particles: Particles) -> None:
        self.grid = grid
        self.window = window
        self.particles = particles
        self.walls: list[Wall] = []
        """Every part of every wall, in the order in which they act."""
        names, of = [], []
        for number, (name, wall) in enumerate(case.walls.items()):
            for k, part in enumerate(audit.placed(wall.surface, case.space_).parts):
                self.walls.append(Wall(part, wall.contact, grid))
                names.append(f"{name}/{k}")
                of.append(number)
        self._names, self._of = tuple(names), tuple(of)
        self._sorts = -1
        self.touched = False
        """Whether any wall acts in this step."""

    def __len__(self) -> int:
        return len(self.walls)

    @property
    def components(self) -> dict[str, Stateful]:
        """The components with a state."""
        return dict(zip(self._names, self.walls, strict=True))

    def state(self) -> State:
        """The state of its walls."""
        return plain_state(self) | state_of(self.components)

    def restore(self, state: State) -> None:
        """Restore a state; the window and the sorting must be restored before."""
        restore_plain(self, state)
        restore(self.components, state)
        if self._sorts >= 0:
            active = self._active()
            for name, wall in self.components.items():
                own = {key.removeprefix(f"{name}/"): value for key, value in state.items()}
                wall.lay(self.window, active, own)  # type: ignore[attr-defined]

    @property
    def moving(self) -> bool:
        """Whether any wall moves, appears or vanishes, as far as known."""
        return any(wall.changes for wall in self.walls)

    def room(self, places: np.ndarray, spacing: float, cells: bool) -> Room:
        """Part of the volume of nodes or cells, at points, m, ``spacing`` m apart, that is not behind walls.

        The part is computed for a plane at the same distance: the integral of the node's spline, or of its
        cell, in front of it. Where walls meet, the parts are multiplied. A point behind several walls is
        mirrored by the wall that it is farthest behind.
        """
        part, deepest = np.ones(len(places)), np.zeros(len(places))
        image = places.copy()
        for wall in self.walls:
            seen = wall.seen_from(places)
            if seen is None:
                continue
            distance, normal = seen
            depth = distance / spacing
            part *= np.clip(depth + 0.5, 0.0, 1.0) if cells else below_surface(depth)
            behind = distance < deepest
            deepest[behind] = distance[behind]
            image[behind] = places[behind] - 2 * distance[behind, None] * normal[behind]
        return Room(part, deepest < 0, image)

    def follow(self, sorting: Sorting) -> None:
        """Set the sorting that gives the nodes that particles can reach."""
        self.sorting = sorting
        self._sorts = -1

    @property
    def work(self) -> float:
        """Work of all walls on the material so far, J."""
        return float(sum(wall.sums[-1] for wall in self.walls))

    def sums(self) -> np.ndarray:
        """Sums of each wall so far, ``(walls, …)``, see ``Wall``."""
        found = np.zeros((len(set(self._of)), len(self.walls[0].sums) if self.walls else 0))
        for number, part in zip(self._of, self.walls, strict=True):
            found[number] += part.sums
        return found

    def fastest(self, t0: float, t1: float) -> float:
        """Upper bound of the speed of all walls between two times, m/s."""
        return max((wall.surface.fastest(t0, t1) for wall in self.walls), default=0.0)

    def move_to(self, time: float) -> None:
        """Move the walls to their positions at a time, s, and keep particles (sorted) out."""
        if self._sorts != self.sorting.sorts:
            active = self._active()
            for wall in self.walls:
                wall.lay(self.window, active)
            self._sorts = self.sorting.sorts
        for wall in self.walls:
            wall.move_to(time)
            wall.keep_out(self.particles.position)

    def _active(self) -> np.ndarray:
        """Which nodes of the window particles can reach, uint8."""
        ends = np.zeros(len(self.window.nodes) + 1, dtype=np.int64)
        rows = self.sorting.active.rows
        np.add.at(ends, rows[:, 0], 1)
        np.add.at(ends, rows[:, 1], -1)
        return (np.cumsum(ends[:-1]) > 0).astype(np.uint8)

    def mark(self, base: np.ndarray, weight: np.ndarray) -> None:
        """Find the nodes that material touches."""
        for wall in self.walls:
            wall.mark(self.particles.position, self.particles.half_size, base, weight)
        self.touched = any(wall.touches for wall in self.walls)

    def fold(self, momentum: bool, forces: bool) -> None:
        """Fold the values on the ghosts of the walls; ghosts of the faces are already folded."""
        for wall in self.walls if self.touched else ():
            wall.fold(momentum, forces)

    def constrain(self, of_faces: np.ndarray, dt: float | None = None, rehearse: bool = False) -> None:
        """Constrain the velocities after mapping, or after the momentum equation (step ``dt`` s), and fill
        ghosts.

        The ghosts of the faces must then be filled again. ``of_faces`` are the sums of the faces, which hold
        nodes against the walls.
        """
        touched, solved = [wall for wall in self.walls if wall.touches], dt is not None
        for wall in touched:
            wall.act(rehearse, dt)
        for turn in range(SWEEPS):
            back = turn % 2 == 0
            for wall in reversed(touched) if back else touched:
                wall.sweep(back, solved)
        for wall in touched:
            wall.count(solved, of_faces)
        for wall in reversed(touched):
            wall.fill(dt)

    def taken_up(self, flip: float) -> None:
        """Count impulses in mapping; particles take the part 1 - ``flip`` of them: see ``move_particles``."""
        for wall in self.walls if self.touched else ():
            wall.taken_up(1 - flip)

    def fold_pairs(self, pairs: np.ndarray) -> None:
        """Fold the sums of an average."""
        for wall in self.walls if self.touched else ():
            if not wall.touches:
                continue
            w = wall.near
            ghosts.fold_pairs(pairs, w.behind, w.at, w.image, w.image_weight, w.touched, w.pair)

    def fill_average(self, average: np.ndarray) -> None:
        """Fill an average on ghosts, including those of the faces."""
        if not self.touched:
            return
        for wall in reversed(self.walls):
            if not wall.touches:
                continue
            w = wall.near
            ghosts.fill_average(average, w.behind, w.at, w.image, w.image_weight, w.touched, w.pair)
        active = self.sorting.active
        node_kernels.fill(average, active.faces, active.mirrors, active.plane_first, 0, 1, False)
