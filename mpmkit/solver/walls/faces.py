"""The faces of the grid as walls: sums of their impulses on the material."""

from __future__ import annotations

import numpy as np

from ...kernels import nodes as node_kernels
from ..active_nodes import ActiveNodes
from ..grid import Grid, Window
from ..stateful import State, plain_state, restore_plain


class Faces:
    """Sums of the impulses that each face gives, see ``kernels.face_impulses``.

    Attributes:
        sums: ``(2 dim, …)``, sums of each face so far, lower before upper, axis by axis: impulse, N s,
            ``(dim,)``, its moment about the origin of the scene, N m s, ``(3,)`` or ``(1,)`` about the axis
            out of the plane, and work, J, which is zero. A plane of symmetry counts as well, the axis too.
        mapped: the same for the last mapping only; a part of it reaches the particles.
    """

    def __init__(self, grid: Grid) -> None:
        self.grid = grid
        self._are_walls = grid.walls.ravel()
        self.sums = np.zeros((2 * grid.dim, grid.dim + (3 if grid.dim == 3 else 1) + 1))
        self.mapped = np.zeros_like(self.sums)

    def state(self) -> State:
        """Its sums."""
        return plain_state(self, but=("_are_walls",))

    def restore(self, state: State) -> None:
        """Restore its sums."""
        restore_plain(self, state)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the faces that are walls, as in ``grid.faces``."""
        of_all = [f"{axis}_{side}" for axis in self.grid.axes for side in ("min", "max")]
        return tuple(name for name, is_wall in zip(of_all, self._are_walls, strict=True) if is_wall)

    def of_walls(self) -> np.ndarray:
        """The sums of the faces that are walls, ``(walls, …)``."""
        return self.sums[self._are_walls]

    def given(self, solved: bool) -> np.ndarray:
        """The sums for impulses: of the mapping, or of the momentum equation if ``solved``."""
        return self.sums if solved else self.mapped

    def fill(self, window: Window, active: ActiveNodes, dt: float | None) -> None:
        """Fill the ghosts once walls have acted on velocities as mapped, or as solved in a step, ``dt`` s."""
        solved = dt is not None
        last = 1 + (2 if solved else 1) * self.grid.dim
        node_kernels.fill_counted(
            window.nodes, active.faces, active.mirrors, active.plane_first, last, solved, dt or 0.0,
            active.places, self.grid.cell_size, active.held, solved, self.sums, self.mapped,
        )  # fmt: skip

    def taken_up(self, part: float) -> None:
        """Count the part of the impulses in mapping that reaches the particles."""
        self.sums += part * self.mapped
