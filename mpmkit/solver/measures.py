"""Scalars of a scene for the history: spread, heights, energies, mass and momentum."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..case.model import Case
from ..kernels.extents import extents
from .crowding import Crowding, crowding
from .density import density_of
from .energies import compressive_energy, kinetic_energy, potential_energy, strain_energy
from .grid import Grid
from .particles import Particles
from .surface import mean_top

SAME = 0.025
"""Accuracy, in cells, of a surface position found from the nodes."""


@dataclass(frozen=True)
class Measures:
    """Measures a scene. Lengths are those of the material in the domain, including its mirror image at a
    symmetry plane; masses, momenta and energies are those of the simulated part.

    Along each axis, the material extends around a particle at x as far as its box (half-size l), with two
    limits:

        from x - min(l, Δx/2) to x + min(l, Δx/2), cut off at the faces of the domain.

    *Half a cell*: a box represents the volume around a particle as long as its neighbours share nodes with
    it. The grid gives no weight to the part of a box beyond a cell, and the ends of such a box are no longer
    connected to the material (``fractured_fraction``): in a splash, strain can make a box kilometres long.
    *The faces*: no material is behind a wall. The boxes of an undeformed body, of a sheet, and of a body
    stretched until its boxes are as long as a cell meet without gaps: their lengths are exact.

    Particles outside the domain are left out; a guard will stop the run because of them.
    """

    case: Case
    grid: Grid
    initial_height: float
    """Height of the top of the material at the start above the grid's lower face, m."""
    axis_position: np.ndarray
    """Horizontal position of the body's axis, m, from the grid's corner."""
    planes: list[float | None]
    """Position of a plane or axis of symmetry on each horizontal axis of the grid, m."""

    @classmethod
    def of(cls, case: Case, grid: Grid, particles: Particles) -> Measures:
        ends = extents(
            particles.position, particles.box, grid.dim, grid.extent, grid.periodic, grid.cell_size / 2
        )
        planes = [_symmetry_plane(case, grid, a) for a in range(grid.dim - 1)]
        if not len(particles):  # a scene that begins empty: what comes in is measured at its first mouth
            mouth = next(iter(case.mouths.values()))
            ends = np.tile((np.array(mouth.centre) - grid.lower)[:, None], 2)
        middle = ends[:-1].mean(axis=1)
        axis = np.array([m if plane is None else plane for plane, m in zip(planes, middle, strict=True)])
        return cls(case, grid, float(ends[-1, 1]), axis, planes)

    def __call__(self, p: Particles) -> dict[str, float | np.ndarray]:
        """All scalar measures by the names of the history's variables."""
        inside = self._inside(p)
        height = self._height(p, inside)
        crowded = crowding(p, self.grid, self.case.space_.radial)
        axis_height = self._axis_height(p, inside, crowded)
        filled = density_of(crowded, p, self.grid, self.case.space_.radial)
        squared = np.einsum("pi,pi->p", p.velocity, p.velocity)
        # Positions are wrapped at a periodic face: the work of gravity along its axis has no potential.
        gravity = np.where(self.grid.periodic, 0.0, self.case.gravity_vector)
        return {
            "spread_diameter": self.spread(p),
            "height": height,
            "axis_height": axis_height,
            "slump": self.initial_height - axis_height,
            "kinetic_energy": kinetic_energy(p),
            "potential_energy": potential_energy(p, gravity)
            - float(np.sum(p.mass)) * (self.grid.lower @ gravity),
            "strain_energy": strain_energy(p),
            "compressive_energy": compressive_energy(p),
            "total_mass": float(np.sum(p.mass)),
            "momentum": np.sum(p.mass[:, None] * p.velocity, axis=0),
            "max_speed": float(np.sqrt(squared.max(initial=0.0))),
            "fractured_fraction": self.fractured(p),
            "density_mean": filled.mean,
            "density_worst": filled.worst,
        }

    def spread(self, p: Particles) -> float:
        """Mean diameter over the horizontal axes, m; periodic axes do not count."""
        grid, periodic, diameters = self.grid, self.grid.periodic, []
        ends = extents(p.position, p.box, grid.dim - 1, grid.extent, periodic, self._longest)
        for a, (low, high) in enumerate(ends.tolist()):
            if periodic[a] or low > high:
                continue
            plane = self.planes[a]
            diameters.append(high - low if plane is None else 2 * max(high - plane, plane - low))
        return sum(diameters) / len(diameters) if diameters else math.nan

    def height(self, p: Particles) -> float:
        """Top of the material above the grid's lower face, m; NaN without material."""
        return self._height(p, self._inside(p))

    def fractured(self, p: Particles) -> float:
        """Part of the volume in boxes longer than a cell: their neighbours no longer share a cell with
        them."""
        longest = p.box.max(axis=1)
        apart = longest > self.grid.cell_size / 2 * (1 + 1e-9)
        return float(np.sum(p.volume[apart]) / np.sum(p.volume)) if len(p) else 0.0

    def _height(self, p: Particles, of: np.ndarray) -> float:
        """Top of some particles above the grid's lower face, m; NaN if there are none."""
        tops = (p.position[:, -1] + np.minimum(p.box[:, -1], self._longest))[of]
        return min(float(tops.max()), float(self.grid.extent[-1])) if len(tops) else np.nan

    def _axis_height(self, p: Particles, inside: np.ndarray, crowded: Crowding | None) -> float:
        """Height of the surface: from the boxes if it agrees with that from the nodes or the latter is not
        known; otherwise from the nodes.

        The tops of boxes are exact in a body with ordered particles. In disorder, the highest box is that of
        a single particle on top of the others.
        """
        by_boxes = self._height(p, inside & self._near_axis(p))
        if crowded is None or math.isnan(by_boxes):
            return by_boxes
        by_nodes = mean_top(crowded, self.axis_position, self.case.space_.radial)
        if math.isnan(by_nodes) or abs(by_nodes - by_boxes) <= SAME * self.grid.cell_size:
            return by_boxes
        return min(by_nodes, float(self.grid.extent[-1]))

    @property
    def _longest(self) -> float:
        """m, largest half-size of a box in lengths; longer boxes are cut to it."""
        return self.grid.cell_size / 2

    def _inside(self, p: Particles) -> np.ndarray:
        """Particles in the domain; without particles whose position is not finite."""
        within = (p.position >= 0) & (p.position <= self.grid.extent)
        # Along a periodic axis, a step may lead out of the domain; the next step wraps the position.
        return np.all((within | self.grid.periodic) & np.isfinite(p.position), axis=1)

    def _near_axis(self, p: Particles) -> np.ndarray:
        """Particles within one cell of the axis of the body."""
        offset = p.position[:, :-1] - self.axis_position
        return np.einsum("pi,pi->p", offset, offset) <= self.grid.cell_size**2


def _symmetry_plane(case: Case, grid: Grid, axis: int) -> float | None:
    """Position of a plane or axis of symmetry on an axis of the grid, m from its corner, or None."""
    if case.space_.radial and axis == 0:
        return 0.0
    for side, position in (("min", 0.0), ("max", float(grid.extent[axis]))):
        if case.grid.faces.get(f"{grid.axes[axis]}_{side}") == "symmetry":
            return position
    return None
