"""Nodes alone: images at the faces, velocities, the momentum equation and its boundary conditions.

A mirror face (a slip wall or a symmetry plane) is exact: what particles put on the ghost nodes behind it is
folded onto the image in front of it with the normal component reversed, as the mirrored scene would put it
there, and after the momentum equation the ghosts get the image's velocity back. A periodic face folds and
fills in the same way; a stick wall continues the velocity as an odd function, all components reversed. A
Coulomb wall is a mirror behind the nodes that touch it and open behind the others.

Setting the ghosts' normal velocity to zero instead, as is often done, takes the normal strain out of every
particle whose box overlaps the wall, and such particles lock: see docs/findings.md.

``nodes`` is (count, NODE); ``shape`` and ``strides`` have three entries, the third 1 in two dimensions.
``walls[a, side]`` is the index of the wall's plane of nodes, ``faces[a, side]`` one of the codes below.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from .compile import function, kernel
from .scatter import CONTACT, NODE

OPEN, MIRROR, STICK, PERIODIC, FRICTION = range(5)


@kernel()
def clear(nodes):
    """All records to zero, but for what is remembered of contact with a wall."""
    for i in prange(len(nodes)):
        for q in range(CONTACT):
            nodes[i, q] = 0.0


@function()
def _transfer(nodes, shape, strides, axis, ghost, image, contact, first, last, sign, folding):
    """Slots first..last-1 of ghosts, times ``sign``, onto their images; or back, if not ``folding``.

    Where ``contact`` is the index of a plane of nodes, only behind those that touch the wall along ``axis``.
    """
    if not (0 <= ghost < shape[axis] and 0 <= image < shape[axis]):
        return
    b, c = (axis + 1) % 3, (axis + 2) % 3
    for i in range(shape[b]):
        for j in range(shape[c]):
            offset = i * strides[b] + j * strides[c]
            if contact >= 0 and not int(nodes[contact * strides[axis] + offset, CONTACT]) & (1 << axis):
                continue
            behind, before = nodes[ghost * strides[axis] + offset], nodes[image * strides[axis] + offset]
            for q in range(first, last):
                if folding:
                    before[q] += sign[q] * behind[q]
                    behind[q] = 0.0
                else:
                    behind[q] = sign[q] * before[q]


@function()
def _parity(face, axis, dim, vectors):
    """Sign of every slot under reflection at a face: scalars are even, what the face reverses is odd."""
    sign = np.ones(NODE)
    if vectors and face != PERIODIC:
        for d in range(dim):
            if d == axis or face == STICK:
                sign[1 + d] = sign[1 + dim + d] = -1.0
    return sign


@function()
def _reflect(nodes, shape, strides, dim, faces, walls, first, last, vectors, folding):
    for step in range(dim):
        a = step if folding else dim - 1 - step  # filling undoes folding in the opposite order
        for side in range(2):
            face, wall, inward = faces[a, side], walls[a, side], 1 - 2 * side
            sign = _parity(face, a, dim, vectors)
            if face == PERIODIC:
                cells = walls[a, 1] - walls[a, 0]
                for depth in range(1 + side):  # the upper wall itself is an image of the lower one
                    ghost = wall - inward * (1 - depth)
                    image = walls[a, 0] + (ghost - walls[a, 0]) % cells
                    _transfer(nodes, shape, strides, a, ghost, image, -1, first, last, sign, folding)
            elif face != OPEN:
                ghost, image = wall - inward, wall + inward
                contact = wall if face == FRICTION and vectors else -1
                _transfer(nodes, shape, strides, a, ghost, image, contact, first, last, sign, folding)


@function()
def fold(nodes, shape, strides, dim, faces, walls, first, last, vectors):
    """Add what lies on ghost nodes to their images, slots first..last-1, and clear the ghosts.

    With ``vectors``, slots 1..dim and dim+1..2 dim are the components of vectors; otherwise all are scalars.
    """
    _reflect(nodes, shape, strides, dim, faces, walls, first, last, vectors, True)


@function()
def fill(nodes, shape, strides, dim, faces, walls, first, last, vectors):
    """Give ghost nodes the values of their images, slots first..last-1; the transpose of ``fold``."""
    _reflect(nodes, shape, strides, dim, faces, walls, first, last, vectors, False)


@function()
def _constrain(nodes, shape, strides, dim, faces, walls, friction, solved):
    """Boundary conditions on the velocity and, once ``solved``, on its change."""
    for a in range(dim):
        for side in range(2):
            face = faces[a, side]
            inward, k = 1 - 2 * side, walls[a, side]
            if face in (OPEN, PERIODIC) or not 0 <= k < shape[a]:
                continue
            b, c = (a + 1) % 3, (a + 2) % 3
            for i in range(shape[b]):
                for j in range(shape[c]):
                    node = nodes[k * strides[a] + i * strides[b] + j * strides[c]]
                    if face == FRICTION:
                        _touch(node, dim, a, inward, friction[a, side], solved)
                        continue
                    for d in range(dim):
                        if d == a or face == STICK:
                            node[1 + d] = 0.0
                            if solved:
                                node[1 + dim + d] = 0.0


@function()
def _touch(node, dim, a, inward, coefficient, solved):
    """Coulomb's law at a node of a wall that pushes and does not pull.

    Whether a node is in contact is decided once a step, by the momentum equation: it is if the wall must take
    up velocity towards it. Until the next decision its normal velocity is held, whatever its sign; a contact
    that opened as soon as the mapped velocity turned would strain the last cell on approach but never on
    departure, and with USF and MUSL feed energy in. Drag takes at most coefficient × push from the slip.
    """
    contacts, this = int(node[CONTACT]), 1 << a  # a node in a corner may touch one wall and not the other
    if not solved:
        if contacts & this:
            node[1 + a] = 0.0
        return
    push = -inward * node[1 + a]
    if push <= 0.0:
        node[CONTACT] = contacts & ~this
        return
    node[CONTACT] = contacts | this
    node[1 + dim + a] -= node[1 + a]
    node[1 + a] = 0.0
    slip = 0.0
    for d in range(dim):
        if d != a:
            slip += node[1 + d] ** 2
    slip = math.sqrt(slip)
    lost = min(1.0, coefficient * push / slip) if slip > 0.0 else 0.0
    for d in range(dim):
        if d != a:
            node[1 + dim + d] -= lost * node[1 + d]
            node[1 + d] -= lost * node[1 + d]


@kernel()
def divide_pairs(pairs, average, shape, strides, dim, faces, walls):
    """Σ w f / Σ w at every node, zero where nothing is, with what lies on ghosts folded in and filled back.

    Leaves ``pairs`` empty, for the next average.
    """
    fold(pairs, shape, strides, dim, faces, walls, 0, 2, False)
    for i in prange(len(pairs)):
        weight = pairs[i, 0]
        average[i, 0] = pairs[i, 1] / weight if weight > 0.0 else 0.0
        pairs[i, 0] = pairs[i, 1] = 0.0
    fill(average, shape, strides, dim, faces, walls, 0, 1, False)


@kernel()
def momentum_to_velocity(nodes, shape, strides, dim, faces, walls, friction):
    """v = p / m, with the conditions on the faces and the ghosts filled. Forces are left as they are."""
    for i in prange(len(nodes)):
        m = nodes[i, 0]
        if m > 0.0:
            for d in range(dim):
                nodes[i, 1 + d] /= m
    _constrain(nodes, shape, strides, dim, faces, walls, friction, False)
    fill(nodes, shape, strides, dim, faces, walls, 1, 1 + dim, True)


@kernel()
def solve_momentum(nodes, shape, strides, dim, faces, walls, friction, dt):
    """Δv = dt f / m, v ← v + Δv, with the conditions on the faces and the ghosts filled."""
    for i in prange(len(nodes)):
        m = nodes[i, 0]
        if m > 0.0:
            for d in range(dim):
                change = dt * nodes[i, 1 + dim + d] / m
                nodes[i, 1 + d] += change
                nodes[i, 1 + dim + d] = change
    _constrain(nodes, shape, strides, dim, faces, walls, friction, True)
    fill(nodes, shape, strides, dim, faces, walls, 1, 1 + 2 * dim, True)
