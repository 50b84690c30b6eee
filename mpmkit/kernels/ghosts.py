"""Ghosts behind a wall at any place and angle: they continue the field in front of it, as a mirror does.

A ghost has v_ghost = w + R (v_image - w). R reverses the normal part (mirror), or the whole vector (odd).
Mass, momentum and force of a ghost are folded onto the nodes around its image, with the weights with which
its velocity is filled back: the two operations are transposes of each other. Averages of scalars fold and
fill all nodes behind the wall.

``nodes`` is (count, NODE), see ``scatter``. There are few ghosts, so these loops run in one thread.
"""

from __future__ import annotations

import numpy as np

from .compile import function


@function()
def _reflect(vector, m, w, normal, odd, out):
    """out = m w + R (vector - m w): relative to the wall, the normal part or the whole vector is reversed."""
    along = 0.0
    for a in range(len(normal)):
        along += (vector[a] - m * w[a]) * normal[a]
    for a in range(len(normal)):
        out[a] = 2.0 * m * w[a] - vector[a] if odd else vector[a] - 2.0 * along * normal[a]


@function()
def fold(nodes, ghost, at, normal, wall_velocity, index, weight, touched, odd, momentum, forces, held):
    """Add the records of touched ghosts to the nodes around their images, and clear the ghosts.

    ``held`` (k, 1 + 2 dim) keeps mass, momentum and force of each, to compute its part of the wall force.
    """
    dim = normal.shape[1]
    first, last = 0 if momentum else 1 + dim, 1 + (2 if forces else 1) * dim
    v, f, none = np.empty(dim), np.empty(dim), np.zeros(dim)
    for k in ghost:
        g = at[k]
        held[k, first:last] = 0.0
        if not touched[g] or weight[k, 0] < 0.0:
            continue
        for q in range(first, last):
            held[k, q] = nodes[g, q]
            nodes[g, q] = 0.0
        m = held[k, 0]
        if momentum:
            _reflect(held[k, 1 : 1 + dim], m, wall_velocity[k], normal[k], odd, v)
        if forces:
            _reflect(held[k, 1 + dim :], 0.0, none, normal[k], odd, f)
        for c in range(index.shape[1]):
            w, i = weight[k, c], index[k, c]
            if momentum:
                nodes[i, 0] += w * m
                for a in range(dim):
                    nodes[i, 1 + a] += w * v[a]
            if forces:
                for a in range(dim):
                    nodes[i, 1 + dim + a] += w * f[a]


@function()
def fill(
    nodes, ghost, at, normal, wall_velocity, index, weight, touched, odd, solved, dt, held, impulse, mapped
):
    """Give touched ghosts the velocity of their images, mirrored; the transpose of ``fold``.

    After the momentum equation (``solved``), ``impulse`` (k, dim), N s, becomes the impulse of the wall
    through each ghost, m (Δv_ghost - Δv_image) + dt (R f - f), with m, p and f of the ghost. ``mapped``
    becomes that of the mapping, m (v_ghost - v_image) + R p - p, with the velocities as mapped, v - Δv. It is
    computed only now, because a face of the grid that begins to push in this step may change these
    velocities.
    """
    dim = normal.shape[1]
    v, change, folded, none = np.empty(dim), np.empty(dim), np.empty(dim), np.zeros(dim)
    for k in ghost:
        g = at[k]
        impulse[k, :] = mapped[k, :] = 0.0
        if not touched[g] or weight[k, 0] < 0.0:
            continue
        v[:] = 0.0
        change[:] = 0.0
        for c in range(index.shape[1]):
            for a in range(dim):
                v[a] += weight[k, c] * nodes[index[k, c], 1 + a]
                change[a] += weight[k, c] * nodes[index[k, c], 1 + dim + a]
        _reflect(v, 1.0, wall_velocity[k], normal[k], odd, nodes[g, 1 : 1 + dim])
        if solved:
            m = held[k, 0]
            _reflect(change, 0.0, none, normal[k], odd, nodes[g, 1 + dim : 1 + 2 * dim])
            _reflect(held[k, 1 + dim :], 0.0, none, normal[k], odd, folded)
            for a in range(dim):
                gained = nodes[g, 1 + dim + a] - change[a]
                impulse[k, a] = m * gained + dt * (folded[a] - held[k, 1 + dim + a])
                mapped[k, a] = m * (nodes[g, 1 + a] - v[a] - gained)
            _reflect(held[k, 1 : 1 + dim], m, wall_velocity[k], normal[k], odd, folded)
            for a in range(dim):
                mapped[k, a] += folded[a] - held[k, 1 + a]


@function()
def press(ghost, normal, foot, foot_weight, held, dt, pressed):
    """Add the normal impulses of the wall through its ghosts, N s, to ``pressed`` (nodes,) at the wall's
    nodes: dt (R f - f)·n = -2 dt f·n for each ghost."""
    dim = normal.shape[1]
    for k in ghost:
        if foot_weight[k, 0] >= 0.0:
            given = 0.0
            for a in range(dim):
                given -= 2.0 * dt * held[k, 1 + dim + a] * normal[k, a]
            for c in range(foot.shape[1]):
                pressed[foot[k, c]] += foot_weight[k, c] * given


@function()
def fold_pairs(pairs, behind, at, index, weight, touched, held):
    """Add the sums of an average at touched ghosts to the nodes around their images, and clear the ghosts."""
    for k in behind:
        g = at[k]
        held[k, 0] = held[k, 1] = 0.0
        if touched[g]:
            held[k, 0], held[k, 1] = pairs[g, 0], pairs[g, 1]
            pairs[g, 0] = pairs[g, 1] = 0.0
    for k in behind:
        if held[k, 0] != 0.0:
            for c in range(index.shape[1]):
                if weight[k, c] > 0.0:
                    pairs[index[k, c], 0] += weight[k, c] * held[k, 0]
                    pairs[index[k, c], 1] += weight[k, c] * held[k, 1]


@function()
def fill_average(average, behind, at, index, weight, touched, held):
    """Give touched ghosts the average at their images."""
    for k in behind:
        g = at[k]
        if touched[g]:
            value = 0.0
            for c in range(index.shape[1]):
                value += weight[k, c] * average[index[k, c], 0]
            held[k, 0] = value
    for k in behind:
        if touched[at[k]]:
            average[at[k], 0] = held[k, 0]
