"""Drawings of the walls of a run at the times of its frames."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..case.model import Case
from ..geometry import contour
from ..output import Drawn, WallFrameWriter
from ..registry import audit
from ..solver.stateful import State, Stateful, plain_state, restore, restore_plain, state_of

SPACING = {2: 1 / 8, 3: 1 / 2}
"""Cell size of a drawing, in cells of the grid, by the number of dimensions; it limits sharp edges."""
AROUND = 1.0
"""Cells by which a drawing extends beyond the faces of the grid, to include a rim on a face."""


class WallFrames:
    """Draws each wall of a case, with any surface, as the contour of its distance at 0.

    ``add`` is to be called in a block of ``blaming_plugins``.
    """

    def __init__(self, case: Case, directory: Path, goes_on: bool) -> None:
        """
        Args:
            case: whose walls are drawn.
            directory: the ``frames/`` of a run.
            goes_on: whether ``restore`` is called next.
        """
        self._surfaces = {name: audit.placed(wall.surface, case.space_) for name, wall in case.walls.items()}
        self._spacing = SPACING[case.space_.dim] * case.grid.cell_size
        self._lower, self._upper = _box(case)
        self._writer = WallFrameWriter(directory, case.space_, tuple(case.walls), goes_on)
        self._last = -math.inf  # s

    @property
    def components(self) -> dict[str, Stateful]:
        """The components with a state."""
        return {"writer": self._writer}

    def state(self) -> State:
        """The files so far, and the time of the last ones."""
        return plain_state(self, but=("_spacing", "_lower", "_upper")) | state_of(self.components)

    def restore(self, state: State) -> None:
        """Restore them."""
        restore_plain(self, state)
        restore(self.components, state)

    def add(self, time: float, step: int) -> None:
        """Write the walls at a time, s."""
        if not self._surfaces:
            return
        drawn = {
            name: None if self._is_as_before(surface, time) else self._draw(surface, time)
            for name, surface in self._surfaces.items()
        }
        self._writer.write(time, step, drawn)
        self._last = time

    def _is_as_before(self, surface: audit.AuditedSurface, time: float) -> bool:
        if not math.isfinite(self._last):
            return False
        there = surface.present(time)
        return there == surface.present(self._last) and not (there and surface.fastest(self._last, time) > 0)

    def _draw(self, surface: audit.AuditedSurface, time: float) -> Drawn:
        dim = len(self._lower)
        nothing = Drawn(np.zeros((0, dim)), np.zeros((0, dim), dtype=np.int64), np.zeros((0, dim)))
        if not surface.present(time):
            return nothing
        points, parts = contour(lambda x: surface.distance(x, time), self._lower, self._upper, self._spacing)
        return Drawn(points, parts, surface.velocity(points, time)) if len(points) else nothing


def _box(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Corners, m, of the drawn box: the domain with a margin at its faces, except at planes of symmetry."""
    lower, upper = (end.copy() for end in case.domain_bounds)
    for number, axis in enumerate(case.space_.axes):
        for end, side, sign in ((lower, "min", -1), (upper, "max", 1)):
            face = case.grid.faces.get(f"{axis}_{side}", "open")
            if face not in ("symmetry", "periodic") and (axis, side) != ("r", "min"):
                end[number] += sign * AROUND * case.grid.cell_size
    return lower, upper
