"""How densely the interior of the material is filled: what of it lies at the nodes, over what should."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .crowding import Crowding, crowding
from .grid import Grid
from .particles import Particles

FULL = 0.75
"""Filling from which a node is full; one that is full, as all around it are, is of the interior."""

TOUCHING = 0.97
"""Filling of a node on a wall that material touches: 1 - 3 g/2, with g = 0.02 cells between them."""


@dataclass(frozen=True)
class Density:
    """Density of the interior of the material, each node's over that of the material there.

    κ_n = Σ_p V_p N_np / V_n, with the quadratic B-splines N of the grid's nodes, the present volumes
    V_p = J V_0 of the particles and the room V_n of a node, all of it mirrored at walls; in an axisymmetric
    scene with areas V / (2πr). Mass over volume is ρ/J in the material and Σ m_p N_np / V_n at a node. Their
    quotient is κ: it is one, whatever the pressure, where particles lie as densely as their volumes say. That
    holds for solids as well, whose J is that of their deformation. The *interior* are the nodes with
    κ >= 0.75 whose neighbours all have κ >= 0.75 as well; at a surface, less is right. So it is at a wall
    that material leaves: a node on a wall is of the interior only if κ >= 0.97, as with a gap of 0.02 cells.

    Means are by volume. Where no node is inside, they are NaN, and so is the worst.
    """

    mean: float
    """Mean of κ over the interior."""
    worst: float
    """κ of the node of the interior that departs most from one."""
    departure: float
    """Mean of |κ - 1| over the interior. Too much in one place does not make up for too little in another."""
    part: float
    """Volume of the interior over that of all material."""
    place: np.ndarray
    """Where the worst node is, m, from the grid's lower corner, ``(dim,)``."""


def density(p: Particles, grid: Grid, radial: bool) -> Density:
    """The density of the interior; of a state between two steps, in whatever order the particles are."""
    return density_of(crowding(p, grid, radial), p, grid, radial)


def density_of(found: Crowding | None, p: Particles, grid: Grid, radial: bool) -> Density:
    """The density of the interior, where the crowding is known already."""
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
    if radial:  # a ring up to half a cell to either side, and no further than the axis and the last face
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
