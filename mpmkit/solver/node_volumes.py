"""Volume of a node: the volume of the domain, weighted by the linear function of the node."""

from __future__ import annotations

import math

import numpy as np

from ..kernels.nodes import OPEN, PERIODIC
from .grid import Grid, Window


def node_volumes(window: Window, radial: bool, on_axis: float = math.inf) -> np.ndarray:
    """V_n = ∫ N_n dV over the domain, m³, of every node of a window, ``(nodes,)``.

    If the boxes of a body tile it, Σ_p V_p N_np = V_n at an inner node for every shape function, and less at
    its surface. Volume on ghosts counts to their images, whose V_n covers both. Only on an axis, V_n depends
    on the shape function: there it is 2 π Δx² times ``on_axis``; default: infinity.
    """
    grid = window.grid
    volumes = np.ones(1)
    for axis in range(grid.dim):
        number = window.lower[axis] + np.arange(window.shape[axis])
        along = _radial(grid, number, on_axis) if radial and axis == 0 else _straight(grid, axis, number)
        volumes = np.multiply.outer(volumes, along)
    return volumes.ravel()


def _straight(grid: Grid, axis: int, number: np.ndarray) -> np.ndarray:
    """Half a cell at walls; 0 at an open face and along a periodic axis."""
    length = np.full(len(number), grid.cell_size)
    for side, wall in enumerate((0, grid.cells[axis])):
        if grid.faces[axis, side] not in (OPEN, PERIODIC):
            length[number == wall] /= 2
    return length


def _radial(grid: Grid, number: np.ndarray, on_axis: float) -> np.ndarray:
    """∫ N_n 2 π r dr: 2 π r Δx, and at a wall half of that, less since the half is the inner one."""
    turns = np.where(number == 0, on_axis, np.abs(number))
    if grid.faces[0, 1] != OPEN:
        turns = np.where(number == grid.cells[0], number / 2 - 1 / 6, turns)
    return 2 * math.pi * grid.cell_size**2 * turns
