"""The functions for measurements of a case: depth, surface, front, forces of walls, and what sinks take."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from ..case.measurements import NAMES, Measurement, functions, means, measured
from ..kernels.extents import extents
from ..solver.crowding import Crowding, crowding
from ..solver.simulation import Simulation
from ..solver.surface import mean_top


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
            low, high = self._strip(axis, x - grid.lower[axis])
            volume, area = volume * self._share(axis, low, high), area * (high - low)
        return float(volume.sum() / area)

    def _strip(self, axis: int, middle: float) -> tuple[float, float]:
        """Ends, m, of what is within half a cell of a place along an axis of the grid.

        Beside a plane of symmetry it is the whole cell in front of the plane. Half a cell has a single row of
        particles there, and in a corner a single column: the grid does not see how full that is. The surface
        is level at the plane, so that the depth of the cell is that at the plane, to second order.
        """
        grid = self._simulation.grid
        end, half = float(grid.extent[axis]), grid.cell_size / 2
        if self._is_plane(axis, "min"):
            middle = max(middle, half)
        if self._is_plane(axis, "max"):
            middle = min(middle, end - half)
        return max(middle - half, 0.0), min(middle + half, end)

    def _is_plane(self, axis: int, side: str) -> bool:
        """Whether an end of an axis of the grid is a plane of symmetry, or the axis of revolution."""
        case = self._simulation.case
        axis_of_revolution = case.space_.radial and axis == 0 and side == "min"
        return axis_of_revolution or case.grid.faces.get(f"{case.space_.axes[axis]}_{side}") == "symmetry"

    def _share(self, axis: int, low: float, high: float) -> np.ndarray:
        """Part of each particle's box, (n,), that is in a strip of the domain along an axis of the grid. What
        of a box is behind a face is mirrored at it, so that no volume is lost."""
        s = self._simulation
        p, end = s.particles, float(s.grid.extent[axis])
        x, half = p.position[:, axis], np.minimum(p.box[:, axis], s.grid.cell_size / 2)
        images = (x, x - end, x + end) if s.grid.periodic[axis] else (x, -x, 2 * end - x)
        parts = [np.clip(np.minimum(i + half, high) - np.maximum(i - half, low), 0.0, None) for i in images]
        return np.sum(parts, axis=0) / (2 * half)

    def surface(self, *place: float) -> float:
        """Height of the free surface above the lower face of the domain, m, mean within a cell of a vertical
        line; its place along the first axis, m, and in 3-D along y. NaN where the material is thinner than a
        cell."""
        s, found = self._simulation, self._crowding
        if found is None:
            return math.nan
        centre = np.array(place) - s.grid.lower[:-1]
        return mean_top(found, centre, s.case.space_.radial and centre[0] == 0)

    @cached_property
    def _crowding(self) -> Crowding | None:
        s = self._simulation
        return crowding(s.particles, s.grid, s.case.space_.radial)

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
