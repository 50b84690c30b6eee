"""Merging of two particles into one that keeps their sums."""

from __future__ import annotations

import numpy as np

from .particles import Particles

WIDEST = 0.8
"""Largest side, in cells, of the box of a merged particle: it must not be split again at once."""


def merge(p: Particles, pairs: np.ndarray, cell_size: float, radial: bool) -> None:
    """Merge each of ``pairs``, ``(m, 2)`` indices of two particles of the same material and body.

    With the weights w = m / Σ m, which are also those of the initial volumes,

        m = Σ m,   V0 = Σ V0,   V = Σ V,   J = Σ w J,   x = Σ w x,   v = Σ w v,   f = Σ w f

    for stress, pressure and the state of the law. A mean with positive weights stays within a convex yield
    surface, and stores no more energy than the two particles if the stored energy is convex. In an
    axisymmetric scene the radius is r = V0 / (2π A), with the areas A = V0 / (2π r) added up.

    The affine velocity is the linear field that fits both particles best, over their boxes with the second
    moments M = l²/3, at distances d from x:

        C Σ w (M + d dᵀ) = Σ w (C M + (v - v̄) dᵀ)

    So a linear field and the angular momentum of the two boxes are kept. The shape of the new box follows
    from that second moment, and its volume is that of the two boxes.

    Args:
        p: changed in place; the particle with the lower number stays, and numbers are never reused.
        pairs: each particle in at most one of them.
        cell_size: m.
        radial: whether axis 0 is the radius of an axisymmetric scene.
    """
    swapped = p.number[pairs[:, 0]] > p.number[pairs[:, 1]]
    pairs = np.where(swapped[:, None], pairs[:, ::-1], pairs)
    one = pairs[:, 0]
    weight = p.mass[pairs] / p.mass[pairs].sum(axis=1, keepdims=True)
    centre = _centre(p, pairs, weight, radial)
    apart = p.position[pairs] - centre[:, None, :]

    if p.affine.shape[1]:
        p.affine[one] = _affine(p, pairs, weight, apart)
    widest = WIDEST * cell_size / 2
    if p.initial_half_size is not None:
        p.initial_half_size[one] = _mean(p.initial_half_size / p.half_size, pairs, weight)
    for box in (p.box, p.half_size):
        box[one] = _joint_box(box[pairs], weight, apart, widest)
    if p.initial_half_size is not None:
        p.initial_half_size[one] *= p.half_size[one]

    p.position[one] = centre
    for extensive in (p.mass, p.initial_volume, p.volume, p.portion):
        extensive[one] = extensive[pairs].sum(axis=1)
    p.volume_ratio[one] = p.volume[one] / p.initial_volume[one]
    intensive = [
        p.velocity, p.velocity_gradient, p.stress, p.pressure, p.mapped_pressure, p.quadrature, p.expansion,
        p.least_half_size, p.deformation_gradient, p.age,
    ]  # fmt: skip
    for array in intensive:
        if array is not None:
            array[one] = _mean(array, pairs, weight)
    for group in p.groups:
        own = (one >= group.part.start) & (one < group.part.stop)
        local = pairs[own] - group.part.start
        for array in group.state.values():
            array[local[:, 0]] = _mean(array, local, weight[own])
    stays = np.ones(len(p), dtype=bool)
    stays[pairs[:, 1]] = False
    p.take(np.flatnonzero(stays))


def _mean(array: np.ndarray, pairs: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """w_0 f_0 + w_1 f_1, as f_0 + w_1 (f_1 - f_0): equal values stay the same, bit by bit."""
    first, second = array[pairs[:, 0]], array[pairs[:, 1]]
    return first + weight[:, 1].reshape(-1, *(1,) * (array.ndim - 1)) * (second - first)


def _centre(p: Particles, pairs: np.ndarray, weight: np.ndarray, radial: bool) -> np.ndarray:
    centre = _mean(p.position, pairs, weight)
    if radial:
        area = p.initial_volume[pairs] / p.position[pairs, 0]
        centre[:, 0] = p.initial_volume[pairs].sum(axis=1) / area.sum(axis=1)
    return centre


def _affine(p: Particles, pairs: np.ndarray, weight: np.ndarray, apart: np.ndarray) -> np.ndarray:
    velocity = p.velocity[pairs]
    relative = velocity - _mean(p.velocity, pairs, weight)[:, None, :]
    moment = np.einsum("kp,kpi,ij->kpij", weight, p.box[pairs] ** 2 / 3, np.eye(p.dim))
    whole = moment.sum(axis=1) + np.einsum("kp,kpi,kpj->kij", weight, apart, apart)
    moved = np.einsum("kpij,kpjl->kil", p.affine[pairs], moment)
    moved += np.einsum("kp,kpi,kpj->kij", weight, relative, apart)
    return np.linalg.solve(whole.swapaxes(1, 2), moved.swapaxes(1, 2)).swapaxes(1, 2)


def _joint_box(box: np.ndarray, weight: np.ndarray, apart: np.ndarray, widest: float) -> np.ndarray:
    """Half sides, ``(m, dim)``, from the second moment of two boxes ``(m, 2, dim)``, and their volume."""
    dim = box.shape[2]
    shape = np.sqrt(3 * np.einsum("kp,kpi->ki", weight, box**2 / 3 + apart**2))
    volume = np.prod(box, axis=2).sum(axis=1)
    # No side exceeds the limit, or its size before: what is cut off one side is given to the others.
    most = np.maximum(widest, box.max(axis=1))
    held = np.zeros(shape.shape, dtype=bool)
    joint = shape
    for _ in range(dim):
        free = np.maximum((~held).sum(axis=1), 1)
        left = volume / np.prod(np.where(held, most, shape), axis=1)
        joint = np.where(held, most, shape * (left ** (1 / free))[:, None])
        held |= joint > most
    return np.minimum(joint, most)
