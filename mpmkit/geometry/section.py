"""The lattice of particles across a section through which material comes in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..contracts import Mouth
from ..spaces import Space


@dataclass(frozen=True)
class Section:
    """One row of a column of material, without its place along the column.

    Attributes:
        position: m, (n, dim), on the section.
        area: m², (n,), across the column: of 1 m in plane strain, of the whole ring in an axisymmetric scene.
        width: m, (dim,), side lengths of the boxes across the column; 0 along it.
    """

    position: np.ndarray
    area: np.ndarray
    width: np.ndarray


def section(
    mouth: Mouth, space: Space, spacing: Sequence[float] | np.ndarray, bounds: tuple[np.ndarray, np.ndarray]
) -> Section:
    """Particles that fill the part of a section within ``bounds``, m.

    A rectangle gets a whole number of particles across, at about the given spacing, m, ``(dim,)``. A disc
    gets the points of a square lattice around its middle that are in it, at a spacing with which their
    squares have the area of the disc. So the column has the density of the material.
    """
    centre, half = np.array(mouth.centre, dtype=float), np.array(mouth.half_width, dtype=float)
    low, high = np.maximum(centre - half, bounds[0]), np.minimum(centre + half, bounds[1])
    across = [a for a in range(space.dim) if a != mouth.axis]
    lines: list[np.ndarray] = [centre[a : a + 1] for a in range(space.dim)]
    width = np.zeros(space.dim)
    if mouth.round:
        radius = float(half[across[0]])
        step = _step(radius, float(np.mean(np.asarray(spacing)[across])))
        count = int(np.ceil(radius / step))
        offsets = (np.arange(-count, count) + 0.5) * step
        for a in across:
            lines[a], width[a] = centre[a] + offsets, step
    else:
        for a in across:
            count = max(1, round(float((high[a] - low[a]) / spacing[a])))
            width[a] = (high[a] - low[a]) / count
            lines[a] = low[a] + (np.arange(count) + 0.5) * width[a]
    position = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, space.dim)
    if mouth.round:
        apart = (position - centre)[:, across]
        inside = (position[:, across] > low[across]) & (position[:, across] < high[across])
        position = position[(np.einsum("pa,pa->p", apart, apart) < radius**2) & inside.all(axis=1)]
    area = np.full(len(position), np.prod(width[across]))
    if space.radial:
        area = 2 * np.pi * position[:, 0] * area
    return Section(position, area, width)


def _step(radius: float, spacing: float) -> float:
    """Spacing near a given one at which the squares of the lattice points in a disc have its area, m."""
    count = max(1, int(np.ceil(radius / spacing)))
    offsets = (np.arange(-count, count) + 0.5) * spacing
    inside = int(np.sum(offsets[:, None] ** 2 + offsets**2 < radius**2))
    step = radius * np.sqrt(np.pi / max(inside, 1))
    again = (np.arange(-count - 1, count + 1) + 0.5) * step
    now = int(np.sum(again[:, None] ** 2 + again**2 < radius**2))
    return float(step if now == inside else radius * np.sqrt(np.pi / max(now, 1)))
