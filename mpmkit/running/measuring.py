"""The functions for measurements of a case: depth, front, the forces of walls, and what sinks take."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..case.measurements import NAMES, Measurement, functions, means, measured
from ..kernels.extents import extents
from ..solver.simulation import Simulation


def measurements(simulation: Simulation, row: Mapping[str, Any]) -> dict[str, float]:
    """The measurements of a case for a row of its history, which is given without them."""
    return _measured(simulation, row, simulation.case.measurements)


def momentary(simulation: Simulation) -> dict[str, Any]:
    """The scalars of the history at the present step, with the measurements that need no row before it."""
    values, every = simulation.measured(), simulation.case.measurements
    passing = means(every)
    return values | _measured(simulation, values, {key: every[key] for key in every if key not in passing})


def _measured(
    simulation: Simulation, row: Mapping[str, Any], which: Mapping[str, Measurement]
) -> dict[str, float]:
    if not which:
        return {}
    names = {name: float(row[name]) for name in NAMES if name in row} | {"time": simulation.time}
    return measured(which, names, functions(_Look(simulation, row)))


class _Look:
    """Functions of a state, in the coordinates of the scene."""

    def __init__(self, simulation: Simulation, row: Mapping[str, Any]) -> None:
        self._simulation, self._row = simulation, row

    def depth(self, *place: float) -> float:
        """Mean depth of the material, m, within half a cell of a place along the first axis, m; in 3-D also
        within half a cell of a place along y, if that is given.

        d = Σ V_p w_p / A: w_p is the part of a particle's box over the strip or the cell, and A the area of
        that in the domain. In an axisymmetric scene V/(2πr) stands for V.
        """
        s = self._simulation
        p, grid = s.particles, s.grid
        volume = p.volume / (2 * np.pi * p.position[:, 0]) if s.case.space_.radial else p.volume
        area = float(np.prod(grid.extent[len(place) : -1]))
        for axis, x in enumerate(place):
            part, length = self._share(axis, x - grid.lower[axis])
            volume, area = volume * part, area * length
        return float(volume.sum() / area)

    def _share(self, axis: int, middle: float) -> tuple[np.ndarray, float]:
        """Part of each particle's box, (n,), that is within half a cell of a place along an axis of the grid,
        and the length, m, of that strip."""
        s = self._simulation
        p, grid, end = s.particles, s.grid, float(s.grid.extent[axis])
        low, high = max(middle - grid.cell_size / 2, 0.0), min(middle + grid.cell_size / 2, end)
        half = np.minimum(p.box[:, axis], grid.cell_size / 2)
        # The part of a box behind a face is moved in front of it, so that no volume is lost.
        left = np.maximum(p.position[:, axis] - half, 0.0)
        right = np.minimum(p.position[:, axis] + half, end)
        part = np.clip(np.minimum(right, high) - np.maximum(left, low), 0.0, None) / (right - left)
        return part, high - low

    def front(self) -> float:
        """End of the material along the first axis, m; boxes count as in ``spread_diameter``."""
        s = self._simulation
        p, grid = s.particles, s.grid
        ends = extents(p.position, p.box, 1, grid.extent, grid.periodic, grid.cell_size / 2)
        return float(ends[0, 1] + grid.lower[0]) if math.isfinite(ends[0, 1]) else math.nan

    def width(self, place: float) -> float:
        """Extent of the material along y, m, in 3-D, of the particles within half a cell of a place along the
        first axis; twice that beside a plane of symmetry. Boxes count as in ``spread_diameter``."""
        s = self._simulation
        p, grid, faces = s.particles, s.grid, s.case.grid.faces
        near = np.abs(p.position[:, 0] - (place - grid.lower[0])) <= grid.cell_size / 2
        if s.case.space_.dim < 3 or not near.any():
            return math.nan
        half = np.minimum(p.box[near, 1], grid.cell_size / 2)
        low = max(float((p.position[near, 1] - half).min()), 0.0)
        high = min(float((p.position[near, 1] + half).max()), float(grid.extent[1]))
        if faces.get("y_min") == "symmetry":
            return 2 * high
        return 2 * (float(grid.extent[1]) - low) if faces.get("y_max") == "symmetry" else high - low

    def force(self, wall: str, axis: str) -> float:
        """Force of a wall on the material, N, mean over the time since the last row."""
        s = self._simulation
        return float(self._row["wall_force"][s.wall_names.index(wall), s.case.space_.axes.index(axis)])

    def torque(self, wall: str) -> float:
        """Torque of a wall on the material about the origin, N m, likewise, in plane strain."""
        return float(self._row["wall_torque"][self._simulation.wall_names.index(wall), 0])

    def outflow(self, sink: str) -> float:
        """Rate at which a sink takes mass, kg/s, mean over the time since the last row."""
        return float(self._row["sink_rate"][list(self._simulation.case.sinks).index(sink)])
