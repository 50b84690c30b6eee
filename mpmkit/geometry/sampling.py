"""Filling a shape with particles on the lattice that subdivides the cells of the grid."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..contracts.body_shape import BodyShape
from ..errors import CaseError
from ..registry.audit.body_shapes import size_of, volume_of
from ..spaces import Space
from .filled_boxes import filled_boxes
from .lattice import Rows, rows

_SLAB = 1 << 18
"""Lattice points processed together, so that temporary arrays nearly fit into a cache."""

_THINNEST = 0.5
"""Least thickness of a body, in spacings of the particles."""

_SMALL = 0.1
"""Largest relative correction of the volumes of cut boxes, which are estimated by counting points."""

_SAME_SHARE = 1e-9
"""Relative difference up to which a cut counts as leaving equal parts of the body and of its boxes."""

Corners = tuple[Sequence[float] | np.ndarray, Sequence[float] | np.ndarray]


@dataclass(frozen=True)
class Sample:
    """Particles of a body.

    Attributes:
        position: m, (n, dim).
        volume: initial volume, m³, (n,), as the space counts it.
        half_size: half the side lengths of their boxes, m, (n, dim).
    """

    position: np.ndarray
    volume: np.ndarray
    half_size: np.ndarray


def sample(
    shape: BodyShape,
    space: Space,
    *,
    origin: Sequence[float] | np.ndarray,
    cell_size: float,
    per_axis: Sequence[int],
    keep: Corners | None = None,
) -> Sample:
    """Particles in the boxes of the lattice with spacing s_a = Δx/m_a whose centres are inside the shape.

    Boxes are cut at the ends of the body along an axis and at the ends of ``keep``. A cut row is combined
    with its neighbour, so that none is very thin (:func:`mpmkit.geometry.lattice.rows`). At a slanted or
    curved surface, the length of a box is adjusted to the body (``filled_boxes``): the particle is at the
    centre of its box, and the body is as dense at its surface as inside.

    Uncut boxes are exactly those of the lattice. The filled part of the others is estimated by counting
    points; one factor, close to 1, makes all volumes add up to the exact volume of the kept part. If the kept
    part is the same share of the body as of the boxes, as at a symmetry plane through the middle, the factor
    is that of the whole body: a quarter is then exactly the quarter of the whole, bit by bit.

    Args:
        shape: the body.
        space: the space of the scene.
        origin: a node of the grid, m, (dim,).
        cell_size: Δx, m.
        per_axis: m_a, particles in a cell along each axis, (dim,).
        keep: lower and upper corner, m, of the box outside which the body is cut off, such as the domain.

    Returns:
        The particles, in the order of the lattice, last axis fastest; none if the part is thinner than half a
        spacing along an axis or holds the centre of no box, which the caller reports.

    Raises:
        CaseError: the space cannot hold the shape.
    """
    require_room(shape, space)
    origin = np.asarray(origin, dtype=float)
    spacing = cell_size / np.asarray(per_axis, dtype=float)
    lower, upper = shape.bounds(space)
    near = shape.tolerance * float((upper - lower).max())
    low, high = (lower, upper) if keep is None else _cut(lower, upper, keep, near)
    if (high - low < _THINNEST * spacing - near).any():
        return _none(space)
    axes = []
    for a in range(space.dim):
        cuts = sorted({lower[a], low[a], high[a], upper[a]})
        interval = cuts.index(low[a])
        axes.append(
            rows(cuts, interval, origin=origin[a], cell_size=cell_size, per_cell=per_axis[a], near=near)
        )
    inside = np.concatenate([shape.contains(points, space) for points in _centres(axes)])
    if not inside.any():
        return _none(space)
    centre, side, kept, whole = filled_boxes(shape, space, axes, inside)
    volume = space.particle_volume(centre, side)
    total, part = volume_of(shape, space), shape.part(low, high, space)
    raw, raw_kept = float(volume.sum()), float(volume[kept].sum())
    if raw_kept and abs(part / total - raw_kept / raw) <= _SAME_SHARE:
        _scale_to(total, volume, whole, np.ones(len(kept), dtype=bool))
    elif raw_kept:
        _scale_to(part, volume, whole, kept)
    half_size = np.minimum(side / 2, cell_size / 2)
    return Sample(centre[kept], volume[kept], half_size[kept])


def require_room(shape: BodyShape, space: Space) -> None:
    """Raise CaseError with one sentence if a space cannot hold a shape."""
    if problem := shape.problem(space):
        raise CaseError(problem)


def _scale_to(total: float, volume: np.ndarray, whole: np.ndarray, which: np.ndarray) -> None:
    """Scale the volumes of cut boxes, in place, so that those of ``which`` add up to a total, m³.

    If this is not a small change, the volumes of all boxes are scaled.
    """
    cut = ~whole
    full, rest = float(volume[which & whole].sum()), float(volume[which & cut].sum())
    factor = (total - full) / rest if rest > 0 else 0.0
    if abs(factor - 1) < _SMALL:
        volume[cut] *= factor
    else:
        volume *= total / (full + rest)


def _none(space: Space) -> Sample:
    return Sample(np.empty((0, space.dim)), np.empty(0), np.empty((0, space.dim)))


def _cut(lower: np.ndarray, upper: np.ndarray, keep: Corners, near: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners of the part of a box inside ``keep``; a face within ``near`` of the box's face does not cut."""
    low, high = (np.asarray(corner, dtype=float) for corner in keep)
    return (
        np.where(low > lower + near, low, lower),
        np.where(high < upper - near, high, upper),
    )


def expected_count(
    shape: BodyShape,
    space: Space,
    cell_size: float,
    per_axis: Sequence[int],
    keep: Corners | None = None,
) -> float:
    """Estimate of the number of particles from exact sizes, without creating particles.

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
    require_room(shape, space)
    count = size_of(shape, space) / float(np.prod(cell_size / np.asarray(per_axis, dtype=float)))
    if keep is not None:
        lower, upper = shape.bounds(space)
        left = np.minimum(upper, keep[1]) - np.maximum(lower, keep[0])
        count *= float(np.prod(np.maximum(left, 0) / (upper - lower)))
    return count


def _centres(axes: list[Rows]) -> Iterator[np.ndarray]:
    """Centres (n, dim), m, of the boxes that rows make, a few layers along the first axis at a time."""
    layers = max(1, _SLAB // int(np.prod([len(axis.centre) for axis in axes[1:]])))
    for start in range(0, len(axes[0].centre), layers):
        coordinates = [axes[0].centre[start : start + layers], *(axis.centre for axis in axes[1:])]
        yield np.stack(np.meshgrid(*coordinates, indexing="ij"), axis=-1).reshape(-1, len(axes))
