"""Splitting of a particle with a long box into two."""

from __future__ import annotations

import numpy as np

from .available_memory import available_memory
from .grid import Grid
from .particles import Particles


class OutOfMemory(Exception):
    """Not enough memory for the particles that splitting would add; the run probably diverges.

    Attributes:
        particle: index of the one with the longest box.
    """

    def __init__(self, particle: int) -> None:
        super().__init__(f"particle at index {particle} is drawn out too far")
        self.particle = particle


def halve(p: Particles, grid: Grid, which: np.ndarray, axis: int, ring: bool) -> None:
    """Cut the boxes of particles ``which``, ``(n,)`` True or False, in half along an axis.

    Mass, volume and momentum are divided in proportion to the volumes of the halves (in an axisymmetric
    scene the outer half is the larger ring). Both halves keep the stress, the deformation, the state of the
    law and the affine velocity field v + C (x - x̄) of the parent.

    Args:
        p: changed in place. The inner half keeps the parent's number.
        grid: the halves stay between its faces.
        which: the particles.
        axis: along which their boxes are halved.
        ring: whether that is the radius of an axisymmetric scene.

    Raises:
        OutOfMemory: there is not enough memory for the halves.
    """
    _require_memory(p, which)
    # A box ends at a face and at the axis of symmetry; a periodic axis has no end.
    x = p.position[which, axis]
    room = np.full(len(x), np.inf) if grid.periodic[axis] else np.minimum(x, grid.extent[axis] - x)
    twice = np.repeat(np.arange(len(p)), 1 + which)
    p.take(twice)
    inner = np.flatnonzero(np.diff(twice, append=-1) == 0)
    outer = inner + 1
    position = p.position[inner, axis]
    offset = np.minimum(p.box[inner, axis], np.maximum(room, 0.0)) / 2
    share = np.full(len(inner), 0.5)
    if ring:
        share = (position - offset) / (2 * position)
    for half, part, shift in ((inner, share, -offset), (outer, 1 - share, offset)):
        for extensive in (p.mass, p.initial_volume, p.volume):
            extensive[half] *= part
        for size in (p.initial_half_size, p.half_size, p.box):
            if size is not None:
                size[half, axis] /= 2
        p.portion[half] /= 2
        p.position[half, axis] += shift
        if p.affine.shape[1]:  # about the common centroid, to keep the parent's momentum
            from_centroid = shift - (1 - 2 * share) * offset
            p.velocity[half] += p.affine[half, :, axis] * from_centroid[:, None]
    p.number[outer] = p.new_numbers(len(outer))


def _require_memory(p: Particles, which: np.ndarray) -> None:
    """Refuse to add particles if memory is too small, including temporary copies and checkpoints."""
    if 3 * p.nbytes / len(p) * (len(p) + which.sum()) > available_memory():
        raise OutOfMemory(int(np.argmax(p.box.max(axis=1))))
