"""Numerical fracture and its cure: particles that are drawn too far apart are split in two."""

from __future__ import annotations

import numpy as np

from .available_memory import available_memory
from .grid import Grid
from .particles import Particles

SPLIT_WITH = 0.8
"""When a box is too long, those that will soon be are split as well, from this part of the length on: arrays
then grow rarely, and in large pieces."""


class OutOfMemory(Exception):
    """There is no room for the particles that splitting would add: a sign of a run that diverges.

    Attributes:
        particle: index of the one with the longest box.
    """

    def __init__(self, particle: int) -> None:
        super().__init__(f"particle at index {particle} is drawn out too far")
        self.particle = particle


def split(particles: Particles, grid: Grid, radial: bool) -> bool:
    """Halve every box that is longer than a cell along an axis; True if there was one.

    A box longer than a cell leaves cells without a particle, where the grid has no stiffness, and the
    material tears there although its law knows no such thing. The halves share mass, volume and momentum as
    their volumes do (in an axisymmetric scene the outer half is the larger ring); stress, deformation and the
    law's state are the parent's, and so is the affine velocity field, v + C (x - x̄).

    Args:
        particles: changed in place.
        grid: its cells measure the boxes; the halves stay between its faces.
        radial: whether axis 0 is the radius of an axisymmetric scene.
    """
    changed, cell_size = False, grid.cell_size
    for axis in range(particles.dim):
        longest = cell_size / 2 * (1 + 1e-9)
        if particles.box[:, axis].max() <= longest:
            continue
        which = particles.box[:, axis] > SPLIT_WITH * longest
        _require_memory(particles, which)
        # A box does not reach beyond a face, nor across the axis; a periodic axis has no end.
        x = particles.position[which, axis]
        room = np.full(len(x), np.inf) if grid.periodic[axis] else np.minimum(x, grid.extent[axis] - x)
        _halve(particles, which, axis, np.maximum(room, 0.0), radial and axis == 0)
        changed = True
    return changed


def _halve(p: Particles, which: np.ndarray, axis: int, room: np.ndarray, ring: bool) -> None:
    count = len(p)
    twice = np.repeat(np.arange(count), 1 + which)
    p.take(twice)
    inner = np.flatnonzero(np.diff(twice, append=-1) == 0)
    outer = inner + 1
    position = p.position[inner, axis]
    offset = np.minimum(p.box[inner, axis], room) / 2
    share = np.full(len(inner), 0.5)
    if ring:
        share = (position - offset) / (2 * position)
    for half, part, shift in ((inner, share, -offset), (outer, 1 - share, offset)):
        for extensive in (p.mass, p.initial_volume, p.volume):
            extensive[half] *= part
        for size in (p.initial_half_size, p.half_size, p.box):
            if size is not None:
                size[half, axis] /= 2
        p.position[half, axis] += shift
        if p.affine.shape[1]:  # about the centroid of the two, so that they have the parent's momentum
            from_centroid = shift - (1 - 2 * share) * offset
            p.velocity[half] += p.affine[half, :, axis] * from_centroid[:, None]
    p.number[outer] = np.arange(count, count + len(outer))


def _require_memory(p: Particles, which: np.ndarray) -> None:
    """Refuse to add particles that do not fit, copies while they are made, or saved, included."""
    if 3 * p.nbytes / len(p) * (len(p) + which.sum()) > available_memory():
        raise OutOfMemory(int(np.argmax(p.box.max(axis=1))))
