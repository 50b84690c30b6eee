"""How densely the interior of the material is filled: what of it lies at the nodes, over what should."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..kernels.splines import add_sizes
from .grid import Grid, Window
from .particles import Particles
from .redistribution.mirrored import Mirrored

FULL = 0.75
"""Filling from which a node is full; one that is full, as all around it are, is of the interior."""


@dataclass(frozen=True)
class Density:
    """Density of the interior of the material, each node's over that of the material there.

    κ_n = Σ_p V_p N_np / V_n, with the quadratic B-splines N of the grid's nodes, the present volumes
    V_p = J V_0 of the particles and the room V_n of a node, all of it mirrored at walls; in an axisymmetric
    scene with areas V / (2πr). Mass over volume is ρ/J in the material and Σ m_p N_np / V_n at a node. Their
    quotient is κ: it is one, whatever the pressure, where particles lie as densely as their volumes say. That
    holds for solids as well, whose J is that of their deformation. The *interior* are the nodes with
    κ >= 0.75 whose neighbours all have κ >= 0.75 as well; at a surface, less is right.

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
    position, size = _in_domain(p, grid, radial)
    nowhere = Density(math.nan, math.nan, math.nan, 0.0, np.full(grid.dim, math.nan))
    if not len(size):
        return nowhere
    cell = np.floor(position / grid.cell_size).astype(np.int64)
    block = Mirrored(grid, Window(grid).span(cell.min(axis=0), cell.max(axis=0)), 1, False)
    filling = np.zeros(block.count)
    add_sizes(grid.dim)(position, size, 1 / grid.cell_size, block.lower, block.strides, filling)
    block.fold(filling)
    room = block.room()
    filling /= room
    block.fill(filling)
    inside = np.flatnonzero(block.own() & (block.least_around(filling) >= FULL))
    if not len(inside):
        return nowhere
    place = grid.cell_size * (np.array(np.unravel_index(inside, block.shape)).T + block.lower)
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


def _in_domain(p: Particles, grid: Grid, radial: bool) -> tuple[np.ndarray, np.ndarray]:
    """Places, m, and volumes, m³, or in an axisymmetric scene areas, m², of what is in the domain."""
    finite = np.isfinite(p.position).all(axis=1) & np.isfinite(p.volume)
    position, size = p.position[finite], p.volume[finite]
    position = np.where(grid.periodic, np.mod(position, grid.extent), position)
    inside = ((position >= 0) & (position <= grid.extent)).all(axis=1)
    position, size = position[inside], size[inside]
    return position, size / (2 * np.pi * position[:, 0]) if radial else size
