"""Particles on a lattice of cells, and the tables that a shape function fills for them."""

from __future__ import annotations

import numpy as np

from ..contracts import ShapeFunction

DX = 0.05
CELLS = 7
N = 400
EMPTY = -99
"""What a ``base`` holds before it is filled."""

Tables = tuple[np.ndarray, np.ndarray, np.ndarray]


def cloud(dim: int, n: int = N, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Positions and half-sizes, among them boxes as wide as a cell and positions on nodes and mid-cells."""
    rng = np.random.default_rng(seed)
    position = rng.uniform(0.0, CELLS * DX, (n, dim))
    half_size = rng.uniform(0.05, 0.5, (n, dim)) * DX
    half_size[: n // 4] = DX / 2
    half_size[n // 4 : n // 2] = DX / 4
    position[: n // 8] = DX * rng.integers(0, CELLS + 1, (n // 8, dim))
    position[n // 8 : n // 4] = DX * (rng.integers(0, CELLS, (n // 4 - n // 8, dim)) + 0.5)
    return position, half_size


def tables(shape: ShapeFunction, position: np.ndarray, half_size: np.ndarray) -> Tables:
    """base ``(n, dim)``, weight and gradient ``(n, dim, support)`` on cells of ``DX``; NaN if not filled."""
    n, dim = position.shape
    base = np.full((n, dim), EMPTY, dtype=np.int32)
    weight = np.full((n, dim, shape.support), np.nan)
    gradient = np.full((n, dim, shape.support), np.nan)
    shape.fill(position, half_size, DX, base, weight, gradient)
    return base, weight, gradient


def nodes_of(shape: ShapeFunction, base: np.ndarray) -> np.ndarray:
    """Positions of the nodes touched, m, ``(..., support)``."""
    return (base[..., None] + np.arange(shape.support)) * DX


def on_all_nodes(shape: ShapeFunction, base: np.ndarray, values: np.ndarray) -> np.ndarray:
    """``(n, CELLS + 5)`` values of one axis on the nodes from -2 on, whatever their ``base``."""
    n = len(base)
    dense = np.zeros((n, CELLS + 5))
    for a in range(shape.support):
        node = base + a + 2
        inside = (node >= 0) & (node < dense.shape[1])
        np.add.at(dense, (np.flatnonzero(inside), node[inside]), values[inside, a])
    return dense


def near_kink(position: np.ndarray, half_size: np.ndarray, within: float) -> np.ndarray:
    """Whether the middle or an edge of the box is so near, in cells, to a node or the middle of a cell."""
    edges = 2 * np.stack([position - half_size, position, position + half_size]) / DX
    return np.any(np.abs(edges - np.rint(edges)) < 2 * within, axis=0)
