"""The functions for measurements of a case: depth, front, and the forces of walls."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..case.measurements import NAMES, functions, measured
from ..kernels.extents import extents
from ..solver.simulation import Simulation


def measurements(simulation: Simulation, row: Mapping[str, Any]) -> dict[str, float]:
    """The measurements of a case for a row of its history, which is given without them."""
    if not simulation.case.measurements:
        return {}
    names = {name: float(row[name]) for name in NAMES if name in row} | {"time": simulation.time}
    look = _Look(simulation, row)
    return measured(
        simulation.case.measurements, names, functions(look.depth, look.front, look.force, look.torque)
    )


class _Look:
    """Functions of a state, in the coordinates of the scene."""

    def __init__(self, simulation: Simulation, row: Mapping[str, Any]) -> None:
        self._simulation, self._row = simulation, row

    def depth(self, x: float) -> float:
        """Mean depth of the material, m, within half a cell of a place along the first axis, m.

        d = Σ V_p w_p / (b Y): w_p is the part of a particle's box within the strip, b the width of the strip
        that is in the domain and Y the domain's width along y. In an axisymmetric scene V/(2πr) stands for V.
        """
        s = self._simulation
        p, grid, space = s.particles, s.grid, s.case.space_
        middle = x - grid.lower[0]
        low = max(middle - grid.cell_size / 2, 0.0)
        high = min(middle + grid.cell_size / 2, float(grid.extent[0]))
        width = float(grid.extent[1]) if grid.dim == 3 else 1.0
        volume = p.volume / (2 * np.pi * p.position[:, 0]) if space.radial else p.volume
        half = np.minimum(p.box[:, 0], grid.cell_size / 2)
        # The part of a box behind a face is moved in front of it, so that no volume is lost.
        left = np.maximum(p.position[:, 0] - half, 0.0)
        right = np.minimum(p.position[:, 0] + half, float(grid.extent[0]))
        part = np.clip(np.minimum(right, high) - np.maximum(left, low), 0.0, None) / (right - left)
        return float((volume * part).sum() / ((high - low) * width))

    def front(self) -> float:
        """End of the material along the first axis, m; boxes count as in ``spread_diameter``."""
        s = self._simulation
        p, grid = s.particles, s.grid
        ends = extents(p.position, p.box, 1, grid.extent, grid.periodic, grid.cell_size / 2)
        return float(ends[0, 1] + grid.lower[0]) if math.isfinite(ends[0, 1]) else math.nan

    def force(self, wall: str, axis: str) -> float:
        """Force of a wall on the material, N, mean over the time since the last row."""
        s = self._simulation
        return float(self._row["wall_force"][s.wall_names.index(wall), s.case.space_.axes.index(axis)])

    def torque(self, wall: str) -> float:
        """Torque of a wall on the material about the origin, N m, likewise, in plane strain."""
        return float(self._row["wall_torque"][self._simulation.wall_names.index(wall), 0])
