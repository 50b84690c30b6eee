"""Drawing of a surface: line segments or triangles at distance zero, by marching simplices."""

from __future__ import annotations

from collections.abc import Callable
from itertools import permutations

import numpy as np

from ..contracts.solid import Found

COARSE = 8
"""Cells along the longest side of the box at the start of the search for the surface."""
MOST = 100_000
"""Cells at the surface up to which they are halved; in three dimensions each makes about two triangles."""
SAME = 1e-6
"""Points closer than this part of a cell are merged."""


def contour(
    distance: Callable[[np.ndarray], Found], lower: np.ndarray, upper: np.ndarray, spacing: float
) -> tuple[np.ndarray, np.ndarray]:
    """Where a distance is zero in a box: line segments in two dimensions, triangles in three.

    Cells that may contain the surface are halved, and the smallest cells are divided into simplices (Doi &
    Koide 1991). In each, d is linear between the corners. The points found are then moved onto the surface
    along its normal. So flat and round parts are exact; an edge is cut off by less than a cell.

    Args:
        distance: d, m, (k,), and its gradient, (k, dim), at points, m, (k, dim); |d| must not be larger than
            the distance to the surface.
        lower, upper: corners of the box, m, (dim,).
        spacing: sides of the cells, m, at most, no more than half of what is between two sides of a wall;
            the cells are wider where there were more than ``MOST`` of them.

    Returns:
        Points, m, (p, dim), and the dim points of each segment or triangle, (s, dim), int.
    """
    dim = len(lower)
    fine = np.maximum(np.ceil((upper - lower) / spacing), 1)
    halvings = max(0, int(np.ceil(np.log2(fine.max() / COARSE))))
    count = np.ceil(fine / 2**halvings).astype(int)
    side = (upper - lower) / count
    cells = _near(distance, np.indices(count).reshape(dim, -1).T, lower, side)
    for _ in range(halvings):
        if not 0 < len(cells) << (dim - 1) <= MOST:
            break
        side = side / 2
        halves = (2 * cells[:, None, :] + _corners(dim)).reshape(-1, dim)
        cells = _near(distance, halves, lower, side)
    return _march(distance, cells, lower, side)


def _corners(dim: int) -> np.ndarray:
    """Corners of a cell of side 1, (2^dim, dim); corner k has bit a of k along axis a."""
    return np.arange(1 << dim)[:, None] >> np.arange(dim) & 1


def _near(
    distance: Callable[[np.ndarray], Found], cells: np.ndarray, lower: np.ndarray, side: np.ndarray
) -> np.ndarray:
    """The cells, (c, dim), in which the surface may be."""
    middle, _ = distance(lower + (cells + 0.5) * side)
    return cells[np.abs(middle) <= np.linalg.norm(side) / 2 * (1 + SAME)]


def _march(
    distance: Callable[[np.ndarray], Found], cells: np.ndarray, lower: np.ndarray, side: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    dim = len(lower)
    if not len(cells):
        return np.zeros((0, dim)), np.zeros((0, dim), dtype=np.int64)
    corners = (cells[:, None, :] + _corners(dim)).reshape(-1, dim)
    first, number = _distinct(corners)
    places = lower + corners[first] * side
    d, _ = distance(places)
    number = number.reshape(len(cells), 1 << dim)
    # A cell falls into the dim! simplices whose corners are reached along its axes in each order.
    paths = [np.cumsum([0, *(1 << axis for axis in order)]) for order in permutations(range(dim))]
    simplices = number[:, np.array(paths)].reshape(-1, dim + 1)
    inside = d[simplices] < 0
    simplices = np.take_along_axis(simplices, np.argsort(~inside, axis=1, kind="stable"), axis=1)
    pairs = [
        _cut(simplices[inside.sum(axis=1) == count], count) for count in range(1, dim + 1)
    ]  # edges that the surface cuts, (s, dim, 2)
    ends = np.concatenate(pairs).reshape(-1, 2)
    first, found = _distinct(ends)
    edges = ends[first]
    start, end = places[edges].swapaxes(0, 1)
    part = d[edges[:, 0]] / (d[edges[:, 0]] - d[edges[:, 1]])
    points = start + part[:, None] * (end - start)
    if len(points):
        off, normal = distance(points)
        points = points - off[:, None] * normal
    return _joined(points, found.reshape(-1, dim), SAME * float(side.min()))


def _cut(simplices: np.ndarray, inside: int) -> np.ndarray:
    """The edges, (s, dim, 2), at which the surface cuts simplices whose first ``inside`` corners lie inside.

    Two corners on either side make a quadrilateral, which is two triangles.
    """
    edges = [(i, j) for i in range(inside) for j in range(inside, simplices.shape[1])]
    if len(edges) == simplices.shape[1] - 1:
        return simplices[:, np.array(edges)]
    (a, b, c, d) = edges
    return np.concatenate([simplices[:, np.array([a, b, d])], simplices[:, np.array([a, d, c])]])


def _distinct(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First index of each distinct row of integers, (r, k), and for each row the number of its distinct row.

    Rows are compared by a hash of 64 bits, which is a hundred times faster than a direct comparison.
    """
    factors = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)
    numbers = (rows.astype(np.uint64) * factors[: rows.shape[1]]).sum(axis=1, dtype=np.uint64)
    _, first, number = np.unique(numbers, return_index=True, return_inverse=True)
    return first, number.reshape(-1)


def _joined(points: np.ndarray, parts: np.ndarray, same: float) -> tuple[np.ndarray, np.ndarray]:
    """Merge equal points, and remove parts that collapse."""
    first, number = _distinct(np.round(points / same).astype(np.int64))
    parts = number[parts]
    ordered = np.sort(parts, axis=1)
    parts = parts[(ordered[:, 1:] != ordered[:, :-1]).all(axis=1)]
    used, parts_of_used = np.unique(parts, return_inverse=True)
    return points[first[used]], parts_of_used.reshape(parts.shape)
