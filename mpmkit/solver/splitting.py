"""Numerical fracture and its cure: particles that are drawn too far apart are split in two."""

from __future__ import annotations

import numpy as np

from .particles import Particles

SPLIT_WITH = 0.8
"""When a box is too long, those that will soon be are split as well, from this part of the length on: arrays
then grow rarely, and in large pieces."""


def split(particles: Particles, extent: np.ndarray, cell_size: float, radial: bool) -> bool:
    """Halve every box that is longer than a cell along an axis; True if there was one.

    A box longer than a cell leaves cells without a particle, where the grid has no stiffness, and the
    material tears there although its law knows no such thing. The halves share mass, volume and momentum as
    their volumes do (in an axisymmetric scene the outer half is the larger ring); stress, deformation and the
    law's state are the parent's, and so is the affine velocity field, v + C (x - x̄).

    Args:
        particles: changed in place.
        extent: lengths of the domain, m; the halves stay in it.
        cell_size: m.
        radial: whether axis 0 is the radius of an axisymmetric scene.
    """
    changed = False
    for axis in range(particles.dim):
        longest = cell_size / 2 * (1 + 1e-9)
        if particles.box[:, axis].max() <= longest:
            continue
        which = particles.box[:, axis] > SPLIT_WITH * longest
        _halve(particles, which, axis, extent[axis], radial and axis == 0)
        changed = True
    return changed


def _halve(p: Particles, which: np.ndarray, axis: int, length: float, ring: bool) -> None:
    count = len(p)
    twice = np.repeat(np.arange(count), 1 + which)
    p.take(twice)
    inner = np.flatnonzero(np.diff(twice, append=-1) == 0)
    outer = inner + 1
    position = p.position[inner, axis]
    to_face = np.minimum(
        position, length - position
    )  # a box does not reach beyond a face, nor across the axis
    offset = np.minimum(p.box[inner, axis], to_face) / 2
    share = np.full(len(inner), 0.5)
    if ring:
        share = (position - offset) / (2 * position)
    for half, part, shift in ((inner, share, -offset), (outer, 1 - share, offset)):
        for extensive in (p.mass, p.initial_volume, p.volume):
            extensive[half] *= part
        for size in (p.initial_half_size, p.half_size, p.box):
            size[half, axis] /= 2
        p.position[half, axis] += shift
        if p.affine.shape[1]:  # about the centroid of the two, so that they have the parent's momentum
            from_centroid = shift - (1 - 2 * share) * offset
            p.velocity[half] += p.affine[half, :, axis] * from_centroid[:, None]
    p.number[outer] = np.arange(count, count + len(outer))
