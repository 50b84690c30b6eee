"""Density of the interior of the material: nodal density relative to the correct density."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .crowding import Crowding, crowding
from .grid import Grid
from .particles import Particles

FULL = 0.75
"""A node with at least this κ is full; a full node with full neighbours is in the interior."""

TOUCHING = 0.97
"""Least κ of a node on a wall that material touches: 1 - 3 g/2 for a gap of g = 0.02 cells."""


@dataclass(frozen=True)
class Density:
    """Density of the interior of the material: density of each node over that of the material there.

    κ_n = Σ_p V_p N_np / V_n, with the quadratic B-splines N of the grid's nodes, the present volumes
    V_p = J V_0 of the particles and the volume V_n of a node, both mirrored at walls; in an axisymmetric
    scene with areas V / (2πr). The density is ρ/J in the material and Σ m_p N_np / V_n at a node. Their ratio
    is κ: it is 1 at any pressure if the positions of the particles agree with their volumes. This also holds
    for solids, whose J is that of their deformation. The *interior* consists of the nodes with κ >= 0.75
    whose neighbours all have κ >= 0.75. Smaller values are correct at a free surface, and at a wall from
    which material separates: a node on a wall is in the interior only if κ >= 0.97 (gap <= 0.02 cells).

    Means are weighted by volume. Without interior nodes, the means and the worst value are NaN.
    """

    mean: float
    """Mean of κ over the interior."""
    worst: float
    """κ of the interior node with the largest |κ - 1|."""
    departure: float
    """Mean of |κ - 1| over the interior. Too high and too low densities do not cancel."""
    part: float
    """Volume of the interior, relative to all material."""
    place: np.ndarray
    """Position of the worst node, m, from the grid's lower corner, ``(dim,)``."""


def density(p: Particles, grid: Grid, radial: bool) -> Density:
    """The density of the interior of a state between two steps; the particles may be in any order."""
    return density_of(crowding(p, grid, radial), p, grid, radial)


def density_of(found: Crowding | None, p: Particles, grid: Grid, radial: bool) -> Density:
    """The density of the interior, if the crowding is already known."""
    nowhere = Density(math.nan, math.nan, math.nan, 0.0, np.full(grid.dim, math.nan))
    if found is None:
        return nowhere
    block, filling, room = found.block, found.values, found.block.room
    inside = np.flatnonzero(block.own() & (block.least_around(filling) >= FULL))
    number = np.array(np.unravel_index(inside, block.shape)).T + block.lower
    at_wall = ((number == 0) & grid.walls[:, 0]) | ((number == grid.cells) & grid.walls[:, 1])
    kept = ~at_wall.any(axis=1) | (filling[inside] >= TOUCHING)
    inside, number = inside[kept], number[kept]
    if not len(inside):
        return nowhere
    place = grid.cell_size * number
    volume = room[inside]
    if radial:  # a ring of half a cell to each side, cut at the axis and the last face
        radius, half = place[:, 0], grid.cell_size / 2
        volume = volume * np.pi * (np.maximum(radius - half, 0) + np.minimum(radius + half, grid.extent[0]))
    filling = filling[inside]
    departure = np.abs(filling - 1)
    worst = int(np.argmax(departure))
    return Density(
        mean=float(filling @ volume / volume.sum()),
        worst=float(filling[worst]),
        departure=float(departure @ volume / volume.sum()),
        part=float(volume.sum() / p.volume.sum()),
        place=place[worst],
    )
