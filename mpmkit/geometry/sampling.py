"""Filling a shape with particles on the lattice that subdivides the cells of the grid."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..spaces import Space
from .base import Shape

_SLAB = 1 << 18
"""Lattice points looked at together: their temporaries fit a cache, or nearly."""

Corners = tuple[Sequence[float] | np.ndarray, Sequence[float] | np.ndarray]


@dataclass(frozen=True)
class Sample:
    """Particles of a body.

    Attributes:
        position: m, (n, dim).
        volume: initial volume, m³, (n,), as the space counts it.
        half_size: half the lattice spacing, m, (n, dim).
    """

    position: np.ndarray
    volume: np.ndarray
    half_size: np.ndarray


def sample(
    shape: Shape,
    space: Space,
    *,
    origin: Sequence[float] | np.ndarray,
    cell_size: float,
    per_axis: Sequence[int],
    keep: Corners | None = None,
) -> Sample:
    """Particles at x_a = origin_a + (i + (s + 1/2)/m_a) Δx, s = 0 … m_a − 1, inside the shape.

    Their volumes are those of the lattice's boxes times one factor, by which they add up to the exact volume
    of the whole body: its total mass is then exact, though its surface on the lattice is a staircase. The
    factor is found before ``keep`` is applied, so that a body cut by symmetry planes keeps its exact share.

    Args:
        shape: the body.
        space: the space of the scene; if axisymmetric, no particle stands at r ≤ 0, where it has no volume.
        origin: a node of the grid, m, (dim,).
        cell_size: Δx, m.
        per_axis: m_a, particles in a cell along each axis, (dim,).
        keep: lower and upper corner, m, of the box outside which particles are dropped, such as the domain.
            Its lower faces belong to it and its upper ones do not: boxes side by side share no particle.

    Returns:
        The particles, in the order of the lattice, last axis fastest; none if the body slips between the
        lattice's points, which the caller reports.

    Raises:
        CaseError: the space cannot hold the shape.
    """
    total = shape.volume(space)
    origin = np.asarray(origin, dtype=float)
    spacing = cell_size / np.asarray(per_axis, dtype=float)
    positions, volumes, raw = [], [], 0.0
    for points in _slabs(*shape.bounds(space), origin, spacing):
        inside = shape.contains(points, space)
        if space.radial:
            inside &= points[:, 0] > 1e-9 * spacing[0]
        points = points[inside]
        volume = space.particle_volume(points, spacing)
        raw += float(volume.sum())
        if keep is not None:
            lower, upper = (np.asarray(corner, dtype=float) - 1e-9 * spacing for corner in keep)
            kept = ((points >= lower) & (points < upper)).all(axis=1)
            points, volume = points[kept], volume[kept]
        positions.append(points)
        volumes.append(volume)
    position = np.concatenate(positions) if positions else np.empty((0, space.dim))
    volume = np.concatenate(volumes) if volumes else np.empty(0)
    if len(volume):
        volume *= total / raw
    return Sample(position, volume, np.tile(spacing / 2, (len(position), 1)))


def expected_count(
    shape: Shape,
    space: Space,
    cell_size: float,
    per_axis: Sequence[int],
    keep: Corners | None = None,
) -> float:
    """Estimate of the number of particles, from exact sizes and without making any.

    It is the shape's size over that of a particle. With ``keep`` it is multiplied by the part of the box
    around the shape that is kept; that is exact for boxes and for cuts through planes of symmetry, and a
    rough estimate for others.

    Args:
        shape: the body.
        space: the space of the scene.
        cell_size: m.
        per_axis: particles in a cell along each axis, (dim,).
        keep: lower and upper corner, m, as for :func:`sample`.

    Raises:
        CaseError: the space cannot hold the shape.
    """
    count = shape.size(space) / float(np.prod(cell_size / np.asarray(per_axis, dtype=float)))
    if keep is not None:
        lower, upper = shape.bounds(space)
        left = np.minimum(upper, keep[1]) - np.maximum(lower, keep[0])
        count *= float(np.prod(np.maximum(left, 0) / (upper - lower)))
    return count


def _slabs(
    lower: np.ndarray, upper: np.ndarray, origin: np.ndarray, spacing: np.ndarray
) -> Iterator[np.ndarray]:
    """Points (n, dim) of the lattice in a box, a few layers along the first axis at a time.

    The box is widened by a millionth of the spacing: what lies on its faces is for the shape to decide.
    """
    first = np.ceil((lower - origin) / spacing - 0.5 - 1e-6).astype(np.int64)
    last = np.floor((upper - origin) / spacing - 0.5 + 1e-6).astype(np.int64)
    if (last < first).any():
        return
    axes = [
        origin[axis] + (np.arange(first[axis], last[axis] + 1) + 0.5) * spacing[axis]
        for axis in range(len(origin))
    ]
    layers = max(1, _SLAB // int(np.prod([len(axis) for axis in axes[1:]])))
    for start in range(0, len(axes[0]), layers):
        mesh = np.meshgrid(axes[0][start : start + layers], *axes[1:], indexing="ij", copy=False)
        points = np.empty((mesh[0].size, len(axes)))
        for axis, values in enumerate(mesh):
            points[:, axis] = values.ravel()
        yield points
