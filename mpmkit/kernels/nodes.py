"""Nodes alone: images at the faces, velocities, the momentum equation and its boundary conditions.

A mirror face (a symmetry plane) is exact: what particles put on the ghost nodes behind it is folded onto the
image in front of it with the normal component reversed, as the mirrored scene would put it there, and after
the momentum equation the ghosts get the image's velocity back. A periodic face folds and fills in the same
way.

A wall acts only at nodes that are touched, see ``kernels.touch``; behind the others it is open. Where it
acts, a Coulomb wall (a slip wall is one without friction) is a mirror, and a stick wall continues the
velocity as an odd function, all components reversed. A Coulomb wall, and a stick wall that releases, acts
at those of the touched nodes that it pushed when the momentum equation was solved last.

Setting the ghosts' normal velocity to zero instead, as is often done, takes the normal strain out of every
particle whose box overlaps the wall, and such particles lock: see docs/findings.md.

``nodes`` is (count, NODE). Nodes that no particle can reach are zero and left out: ``rows`` holds the first
node and the one after the last of each row that is reached, and ``tasks`` cuts the rows into pieces of about
equal load. ``mirrors`` lists (ghost, image, node of the wall) of ``PLANES`` planes an axis, each from its
entry of ``plane_first`` on. Entries of one plane have no node in common, so that they can be handled in
parallel; images of two planes may be the same nodes. ``faces[a, side]`` is one of the codes below.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, function, inline, kernel
from .scatter import CONTACT, NODE, PUSHED, TOUCHED

FEW = 1000
"""Nodes of a plane below which more threads than one are not worth their start."""
PLANES = 3
"""Planes of ghosts an axis: of its lower face, of its upper face, and the upper face of a periodic axis."""
OPEN, MIRROR, STICK, PERIODIC, FRICTION, RELEASING_STICK = range(6)


@inline()
def is_wall(face):
    """Whether a face acts only where it is touched."""
    return face in (STICK, FRICTION, RELEASING_STICK)


@inline()
def _acting(face, a):
    """The bit of ``CONTACT`` that says whether a face across axis a acts at a node; 0 if it always does."""
    if face == STICK:
        return TOUCHED << a
    return PUSHED << a if face in (FRICTION, RELEASING_STICK) else 0


@kernel()
def clear(nodes, rows, tasks):
    """All records to zero, but for what is known of contact with a wall."""
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                for q in range(CONTACT):
                    nodes[i, q] = 0.0


@inline()
def _move(nodes, mirror, acting, first, last, sign, folding):
    """Slots first..last-1 of a ghost, times ``sign``, onto its image; or back, if not ``folding``.

    With ``acting``, a bit of ``CONTACT``, only if the node between them has it.
    """
    ghost, image, wall = mirror
    if not acting or int(nodes[wall, CONTACT]) & acting:
        for q in range(first, last):
            if folding:
                nodes[image, q] += sign[q] * nodes[ghost, q]
                nodes[ghost, q] = 0.0
            else:
                nodes[ghost, q] = sign[q] * nodes[image, q]


@function()
def _move_few(nodes, mirrors, acting, first, last, sign, folding):
    for k in range(len(mirrors)):
        _move(nodes, mirrors[k], acting, first, last, sign, folding)


@kernel()
def _move_many(nodes, mirrors, acting, first, last, sign, folding):
    n = len(mirrors)
    for c in prange(chunk_count(n)):
        for k in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            _move(nodes, mirrors[k], acting, first, last, sign, folding)


@function()
def _parity(face, axis, dim, vectors):
    """Sign of every slot under reflection at a face: scalars are even, what the face reverses is odd."""
    sign = np.ones(NODE)
    if vectors and face != PERIODIC:
        for d in range(dim):
            if d == axis or face in (STICK, RELEASING_STICK):
                sign[1 + d] = sign[1 + dim + d] = -1.0
    return sign


@function()
def _reflect(nodes, faces, mirrors, plane_first, first, last, vectors, folding):
    dim = len(faces)
    for step in range(dim):
        a = step if folding else dim - 1 - step  # filling undoes folding in the opposite order
        for plane in range(PLANES):
            begin, end = plane_first[PLANES * a + plane], plane_first[PLANES * a + plane + 1]
            if begin < end:
                face = faces[a, min(plane, 1)]
                acting = _acting(face, a) if vectors else 0
                of_plane, sign = mirrors[begin:end], _parity(face, a, dim, vectors)
                if len(of_plane) < FEW:
                    _move_few(nodes, of_plane, acting, first, last, sign, folding)
                else:
                    _move_many(nodes, of_plane, acting, first, last, sign, folding)


@function()
def fold(nodes, faces, mirrors, plane_first, first, last, vectors):
    """Add what lies on ghost nodes to their images, slots first..last-1, and clear the ghosts.

    With ``vectors``, slots 1..dim and dim+1..2 dim are the components of vectors; otherwise all are scalars.
    """
    _reflect(nodes, faces, mirrors, plane_first, first, last, vectors, True)


@function()
def fill(nodes, faces, mirrors, plane_first, first, last, vectors):
    """Give ghost nodes the values of their images, slots first..last-1; the transpose of ``fold``."""
    _reflect(nodes, faces, mirrors, plane_first, first, last, vectors, False)


@function()
def _constrain(nodes, faces, mirrors, plane_first, friction, solved):
    """Boundary conditions on the velocity and, once ``solved``, on its change.

    Where walls meet, a node has the conditions of all of them. The pushes of all Coulomb walls come first,
    then the other walls, then the drag of the Coulomb walls: no axis is before another.
    """
    dim = len(faces)
    grip = np.zeros(len(mirrors) if solved else 0)  # largest drag on each wall node, m/s
    for turn in range(3):
        for a in range(dim):
            for side in range(2):
                face, plane = faces[a, side], PLANES * a + side
                begin, end = plane_first[plane], plane_first[plane + 1]
                pushes = face in (FRICTION, RELEASING_STICK)
                if turn == 0 and solved and pushes:
                    _push(nodes, dim, mirrors[begin:end], a, 1 - 2 * side, friction[a, side], grip[begin:end])
                elif turn == 1 and face != OPEN and face != PERIODIC:
                    sticks = face in (STICK, RELEASING_STICK)
                    _hold(nodes, dim, mirrors[begin:end], _acting(face, a), a, sticks, solved)
                elif turn == 2 and solved and face == FRICTION:
                    _drag(nodes, dim, mirrors[begin:end], a, grip[begin:end])


@function()
def _push(nodes, dim, mirrors, a, inward, coefficient, grip):
    """A wall that pushes and does not pull; ``grip`` becomes the slip that it can take up at each node.

    Whether it pushes a node that is touched is decided once a step, by the momentum equation: it does if it
    must take up velocity towards it. Until the next decision the normal velocity is held, whatever its
    sign; a wall that let go as soon as the mapped velocity turned would strain the last cell on approach
    but never on departure, and with USF and MUSL feed energy in.
    """
    for k in range(len(mirrors)):
        node = nodes[mirrors[k, 2]]
        contacts, this = int(node[CONTACT]), PUSHED << a  # in a corner one wall may push and the other not
        push = -inward * node[1 + a]
        if push > 0.0 and contacts & TOUCHED << a:
            node[CONTACT] = contacts | this
            node[1 + dim + a] -= node[1 + a]
            node[1 + a] = 0.0
            grip[k] = coefficient * push
        else:
            node[CONTACT] = contacts & ~this


@function()
def _hold(nodes, dim, mirrors, acting, a, sticks, solved):
    """Nodes where a face acts have its velocity, zero: along the normal, or all of it if it ``sticks``."""
    for k in range(len(mirrors)):
        node = nodes[mirrors[k, 2]]
        if not acting or int(node[CONTACT]) & acting:
            for d in range(dim):
                if d == a or sticks:
                    if solved:
                        node[1 + dim + d] -= node[1 + d]
                    node[1 + d] = 0.0


@function()
def _drag(nodes, dim, mirrors, a, grip):
    """Coulomb's law: drag takes at most coefficient × push from the slip, and never turns it round."""
    for k in range(len(mirrors)):
        if grip[k] > 0.0:
            node = nodes[mirrors[k, 2]]
            slip = 0.0
            for d in range(dim):
                if d != a:
                    slip += node[1 + d] ** 2
            slip = math.sqrt(slip)
            lost = min(1.0, grip[k] / slip) if slip > 0.0 else 0.0
            for d in range(dim):
                if d != a:
                    node[1 + dim + d] -= lost * node[1 + d]
                    node[1 + d] -= lost * node[1 + d]


@kernel()
def find_crowding(pairs, room, most, crowding, rows, tasks, faces, mirrors, plane_first):
    """Σ w / room, from 1 to ``most``, at all nodes but ghosts, which count to their images.

    Leaves ``pairs`` empty.
    """
    fold(pairs, faces, mirrors, plane_first, 0, 2, False)
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                crowding[i] = min(max(1.0, pairs[i, 0] / room[i]), most)
                pairs[i, 0] = pairs[i, 1] = 0.0


@kernel()
def relieve_pairs(pairs, crowding, rows, tasks, faces, mirrors, plane_first):
    """Σ w f / crowding at every node, with what lies on ghosts folded in."""
    fold(pairs, faces, mirrors, plane_first, 0, 2, False)
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                pairs[i, 1] /= crowding[i]


@kernel()
def divide_pairs(pairs, average, rows, tasks, faces, mirrors, plane_first):
    """Σ w f / Σ w at every node, zero where nothing is, with what lies on ghosts folded in and filled back.

    Leaves ``pairs`` empty, for the next average.
    """
    fold(pairs, faces, mirrors, plane_first, 0, 2, False)
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                weight = pairs[i, 0]
                average[i, 0] = pairs[i, 1] / weight if weight > 0.0 else 0.0
                pairs[i, 0] = pairs[i, 1] = 0.0
    fill(average, faces, mirrors, plane_first, 0, 1, False)


@kernel()
def momentum_to_velocity(nodes, rows, tasks, faces, mirrors, plane_first, friction):
    """v = p / m, with the conditions on the faces and the ghosts filled. Forces are left as they are."""
    dim = len(faces)
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                m = nodes[i, 0]
                if m > 0.0:
                    for d in range(dim):
                        nodes[i, 1 + d] /= m
    _constrain(nodes, faces, mirrors, plane_first, friction, False)
    fill(nodes, faces, mirrors, plane_first, 1, 1 + dim, True)


@kernel()
def solve_momentum(nodes, rows, tasks, faces, mirrors, plane_first, friction, dt):
    """Δv = dt f / m, v ← v + Δv, with the conditions on the faces and the ghosts filled."""
    dim = len(faces)
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                m = nodes[i, 0]
                if m > 0.0:
                    for d in range(dim):
                        change = dt * nodes[i, 1 + dim + d] / m
                        nodes[i, 1 + d] += change
                        nodes[i, 1 + dim + d] = change
    _constrain(nodes, faces, mirrors, plane_first, friction, True)
    # With contact, the record's last: a wall pushes a ghost in its plane where it pushes its image.
    fill(nodes, faces, mirrors, plane_first, 1, CONTACT + 1, True)
