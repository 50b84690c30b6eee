"""Crowding of the grid's nodes: particle volume at a node, relative to the volume of the node."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..kernels.splines import add_sizes
from .grid import Grid, Window
from .particles import Particles
from .redistribution.mirrored import Mirrored


@dataclass(frozen=True)
class Crowding:
    """κ_n = Σ_p V_p N_np / V_n at nodes, with the quadratic B-splines N of the grid's nodes.

    V_p = J V_0 are the present volumes of the particles and V_n the volume of a node, both mirrored at walls.
    In an axisymmetric scene, areas V / (2πr) are used.
    """

    block: Mirrored
    """The nodes."""
    values: np.ndarray
    """κ, ``(nodes,)``."""


def crowding(p: Particles, grid: Grid, radial: bool) -> Crowding | None:
    """The crowding of a state between two steps; None if no particle is in the domain."""
    position, size = _in_domain(p, grid, radial)
    if not len(size):
        return None
    cell = np.floor(position / grid.cell_size).astype(np.int64)
    block = Mirrored(grid, Window(grid).span(cell.min(axis=0), cell.max(axis=0)), 1, False)
    values = np.zeros(block.count)
    add_sizes(grid.dim)(position, size, 1 / grid.cell_size, block.lower, block.strides, values)
    block.fold(values)
    values /= block.room
    block.fill(values)
    return Crowding(block, values)


def _in_domain(p: Particles, grid: Grid, radial: bool) -> tuple[np.ndarray, np.ndarray]:
    """Positions, m, and volumes, m³ (axisymmetric: areas, m²), of the particles in the domain."""
    finite = np.isfinite(p.position).all(axis=1) & np.isfinite(p.volume)
    position, size = p.position[finite], p.volume[finite]
    position = np.where(grid.periodic, np.mod(position, grid.extent), position)
    inside = ((position >= 0) & (position <= grid.extent)).all(axis=1)
    position, size = position[inside], size[inside]
    return position, size / (2 * np.pi * position[:, 0]) if radial else size
