"""The part of each box of a lattice that a body fills."""

from __future__ import annotations

import numpy as np

from ..contracts.body_shape import BodyShape
from ..spaces import Space
from .lattice import Rows

POINTS = {2: 8, 3: 4}
"""Points along each axis of a box that the surface cuts, by the number of axes: even, so that a box that a
plane halves is halved."""
STEPS = 4
"""Largest number of steps from a box to the box that it joins."""
_EVEN = 1e-9
"""Relative difference up to which two axes count as equal."""
_MANY = 1 << 13
"""Number of cut boxes that are processed together."""

Boxes = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""Centres, m, (n, dim); sides, m, (n, dim); whether they are in the kept part of the body, (n,); and whether
they are unchanged boxes of the lattice, (n,)."""


def filled_boxes(shape: BodyShape, space: Space, axes: list[Rows], inside: np.ndarray) -> Boxes:
    """The boxes whose centres are inside a shape, with lengths adjusted to the body.

    A box that the surface cuts is shortened along the axis closest to the surface normal, on the side of the
    body; along two or three axes if they are equally close. The part of a box whose centre is outside is
    added to the length of its neighbour on that side. So there is one box for each centre, and none is very
    thin.

    Args:
        shape, space: the body.
        axes: rows of the lattice along each axis.
        inside: (boxes,) whether the centre of each box is inside, last axis fastest.

    Returns:
        The boxes, in the order of the lattice.
    """
    counts = tuple(len(axis.centre) for axis in axes)
    block = inside.reshape(counts)
    cut = np.flatnonzero(_any_around(block) & _any_around(~block))
    part, inwards = _parts(shape, space, axes, counts, cut)
    some = (part > 0) & (part < 1)
    cut, part, inwards = cut[some], part[some], inwards[some]
    step = _steps(counts, inside, cut, part, inwards)
    along = np.abs(step).sum(axis=1)  # number of axes along which a box is cut

    index = np.flatnonzero(inside)
    centre, side, kept = _boxes(axes, counts, index)
    whole = np.ones(len(index), dtype=bool)

    own = inside[cut]
    at = np.searchsorted(index, cut[own])
    lost = (1 - part[own] ** (1 / along[own]))[:, None] * np.abs(step[own]) * side[at]
    centre[at] += step[own] * lost / 2
    side[at] -= lost
    whole[at] = False

    target, last = _joined(counts, inside, _kept(axes, counts), cut, step)
    joins = np.flatnonzero(target >= 0)
    at, way = np.searchsorted(index, target[joins]), step[last[joins]]
    width = _boxes(axes, counts, cut[joins])[1]
    more = ((1 + part[joins]) ** (1 / along[last[joins]]) - 1)[:, None] * np.abs(way) * width
    longer, off = np.zeros((2, *side.shape))  # the sum of two numbers does not depend on their order
    np.add.at(longer, at, more)
    np.add.at(off, at, -way * more / 2)
    side += longer
    centre += off
    whole[at] = False
    return centre, side, kept, whole


def _steps(
    counts: tuple[int, ...], inside: np.ndarray, cut: np.ndarray, part: np.ndarray, inwards: np.ndarray
) -> np.ndarray:
    """Direction from each cut box to the body, (n, dim): -1, 0 or 1 along each axis.

    It is along the axis of the largest component and axes equal to it. An axis counts only if the neighbour
    in this direction is fuller; a neighbour across a plane of symmetry is not.
    """
    most = np.abs(inwards).max(axis=1, keepdims=True)
    step = np.where(np.abs(inwards) >= most * (1 - _EVEN), np.sign(inwards), 0).astype(np.int64)
    number = np.stack(np.unravel_index(cut, counts), axis=1)
    fuller = np.zeros_like(step)
    for a in range(len(counts)):
        along = number[:, a] + step[:, a]
        there = (along >= 0) & (along < counts[a])
        beside = np.where(there, cut + step[:, a] * _stride(counts, a), 0)
        at = np.minimum(np.searchsorted(cut, beside), len(cut) - 1)
        filling = np.where(cut[at] == beside, part[at], inside[beside])
        fuller[:, a] = np.where(there & (filling > part + _EVEN), step[:, a], 0)
    return np.where(fuller.any(axis=1, keepdims=True), fuller, step)


def _stride(counts: tuple[int, ...], axis: int) -> int:
    return int(np.prod(counts[axis + 1 :]))


def _joined(
    counts: tuple[int, ...],
    inside: np.ndarray,
    kept: np.ndarray,
    cut: np.ndarray,
    step: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """The box with its centre inside that each cut box joins, (n,), and the cut box with the last step to it.

    -1 for boxes with their own centre inside, and for those that lead nowhere or to another part of the body.
    """
    strides = np.array([_stride(counts, a) for a in range(len(counts))])
    number = np.stack(np.unravel_index(cut, counts), axis=1)
    target, last, here = np.full(len(cut), -1), np.zeros(len(cut), dtype=np.int64), np.arange(len(cut))
    on_its_way = ~inside[cut]
    for _ in range(STEPS):
        further = number[here] + step[here]
        there = on_its_way & ((further >= 0) & (further < np.array(counts))).all(axis=1)
        following = np.where(there, cut[here] + step[here] @ strides, 0)
        arrived = there & inside[following] & (kept[following] == kept[cut])
        target[arrived], last[arrived] = following[arrived], here[arrived]
        found = np.minimum(np.searchsorted(cut, following), len(cut) - 1)
        on_its_way = there & ~arrived & (cut[found] == following) & ~inside[following]
        here = np.where(on_its_way, found, here)
    return target, last


def _kept(axes: list[Rows], counts: tuple[int, ...]) -> np.ndarray:
    """Whether each box of the lattice is kept, (boxes,)."""
    kept = np.ones(counts, dtype=bool)
    for a, rows in enumerate(axes):
        kept &= rows.kept.reshape([-1 if a == b else 1 for b in range(len(counts))])
    return kept.ravel()


def _any_around(block: np.ndarray) -> np.ndarray:
    """Whether any of a box and its neighbours, corners included, is true."""
    found = block
    for axis in range(block.ndim):
        along = np.moveaxis(found, axis, 0)
        wider = along.copy()
        wider[1:] |= along[:-1]
        wider[:-1] |= along[1:]
        found = np.moveaxis(wider, 0, axis)
    return found.ravel()


def _parts(
    shape: BodyShape, space: Space, axes: list[Rows], counts: tuple[int, ...], index: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Part of each box in the body, (n,), and the position of its middle, in sides of the box, (n, dim)."""
    per_axis = POINTS[space.dim]
    along = (np.arange(per_axis) + 0.5) / per_axis - 0.5
    offset = np.stack(np.meshgrid(*[along] * space.dim, indexing="ij"), axis=-1).reshape(-1, space.dim)
    part, middle = np.empty(len(index)), np.empty((len(index), space.dim))
    for start in range(0, len(index), _MANY):
        some = slice(start, start + _MANY)
        centre, side, _ = _boxes(axes, counts, index[some])
        points = centre[:, None] + side[:, None] * offset
        inside = shape.contains(points.reshape(-1, space.dim), space).reshape(len(centre), -1)
        part[some] = inside.mean(axis=1)
        middle[some] = inside @ offset / np.maximum(inside.sum(axis=1), 1)[:, None]
    return part, middle


def _boxes(
    axes: list[Rows], counts: tuple[int, ...], index: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centres and sides, m, (n, dim), of boxes, and whether they are kept, (n,)."""
    numbers = np.unravel_index(index, counts)
    centre = np.stack([axis.centre[k] for axis, k in zip(axes, numbers, strict=True)], axis=1)
    side = np.stack([axis.width[k] for axis, k in zip(axes, numbers, strict=True)], axis=1)
    kept = np.all([axis.kept[k] for axis, k in zip(axes, numbers, strict=True)], axis=0)
    return centre, side, kept
