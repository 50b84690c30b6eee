"""Loops over nodes: images at the faces, velocities, the momentum equation and its boundary conditions.

A mirror face (a symmetry plane) is exact. The records of the ghost nodes behind it are folded onto the images
in front of it with the normal component reversed, as particles of the mirrored scene would add them. After
the momentum equation the ghosts get the velocity of their images back. A periodic face folds and fills in the
same way.

A wall acts only at nodes that are touched, see ``kernels.touch``; at the others it is open. Where it acts, a
Coulomb wall (a slip wall is one without friction) is a mirror, and a stick wall continues the velocity as an
odd function, with all components reversed. A Coulomb wall, or a stick wall that releases, acts only at those
touched nodes that it pushed when the momentum equation was last solved.

Often the normal velocity of the ghosts is set to zero instead. This removes the normal strain from every
particle whose box overlaps the wall, and such particles lock: see docs/findings.md.

``nodes`` is (count, NODE). Nodes that no particle can reach are zero and are skipped: ``rows`` holds, for
each row that is reached, its first node and the one after its last. ``tasks`` divides the rows into pieces of
about equal load. ``mirrors`` lists (ghost, image, node of the wall) for the ``PLANES`` planes of each axis. A
plane begins at its entry of ``plane_first``. Entries of one plane have no node in common; images of two
planes may be the same nodes. ``faces[a, side]`` is one of the codes below.

``given`` (faces, …) are the sums of the impulses that the faces give to the material, in the order of
``faces``. ``place`` and ``held`` have a row for each of ``mirrors``. See ``face_impulses`` for all three.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from . import face_impulses
from .compile import function, inline, kernel
from .scatter import CONTACT, NODE, PUSHED, TOUCHED

PLANES = 3
"""Planes of ghosts for each axis: lower face, upper face, and upper face of a periodic axis."""
OPEN, MIRROR, STICK, PERIODIC, FRICTION, RELEASING_STICK = range(6)


@inline()
def is_wall(face):
    """Whether a face acts only at touched nodes."""
    return face in (STICK, FRICTION, RELEASING_STICK)


@inline()
def _acting(face, a):
    """The bit of ``CONTACT`` that says whether a face across axis a acts at a node; 0 if it always does."""
    if face == STICK:
        return TOUCHED << a
    return PUSHED << a if face in (FRICTION, RELEASING_STICK) else 0


@inline()
def holds(face, contact, a):
    """Whether a face across axis a holds a node in its plane, from the contact bits of the node."""
    acting = _acting(face, a)
    return face not in (OPEN, PERIODIC) and (not acting or contact & acting)


@kernel()
def clear(nodes, rows, tasks):
    """Set all records to zero, except the bits of contact with a wall."""
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                for q in range(CONTACT):
                    nodes[i, q] = 0.0


@function()
def _move(nodes, mirrors, acting, first, last, sign, folding):
    """Add slots first..last-1 of ghosts, times ``sign``, to their images; or copy back, if not ``folding``.

    If ``acting``, a bit of ``CONTACT``, is not 0, only where the wall node between them has this bit.
    """
    for k in range(len(mirrors)):
        ghost, image, wall = mirrors[k]
        if not acting or int(nodes[wall, CONTACT]) & acting:
            for q in range(first, last):
                if folding:
                    nodes[image, q] += sign[q] * nodes[ghost, q]
                    nodes[ghost, q] = 0.0
                else:
                    nodes[ghost, q] = sign[q] * nodes[image, q]


@function()
def _parity(face, axis, dim, vectors):
    """Sign of every slot under reflection at a face: 1 for scalars, -1 for components that it reverses."""
    sign = np.ones(NODE)
    if vectors and face != PERIODIC:
        for d in range(dim):
            if d == axis or face in (STICK, RELEASING_STICK):
                sign[1 + d] = sign[1 + dim + d] = -1.0
    return sign


@function()
def _reflect_plane(nodes, face, axis, of_plane, dim, first, last, vectors, folding):
    acting = _acting(face, axis) if vectors else 0
    sign = _parity(face, axis, dim, vectors)
    _move(nodes, of_plane, acting, first, last, sign, folding)


@function()
def _reflect(nodes, faces, mirrors, plane_first, first, last, vectors, folding):
    dim = len(faces)
    for step in range(dim):
        a = step if folding else dim - 1 - step  # filling goes through the axes in the opposite order
        for plane in range(PLANES):
            begin, end = plane_first[PLANES * a + plane], plane_first[PLANES * a + plane + 1]
            if begin < end:
                face = faces[a, min(plane, 1)]
                _reflect_plane(nodes, face, a, mirrors[begin:end], dim, first, last, vectors, folding)


@function()
def fold(nodes, faces, mirrors, plane_first, first, last, vectors):
    """Add slots first..last-1 of ghost nodes to their images, and clear the ghosts.

    With ``vectors``, slots 1..dim and dim+1..2 dim are the components of vectors; otherwise all are scalars.
    """
    _reflect(nodes, faces, mirrors, plane_first, first, last, vectors, True)


@function()
def fill(nodes, faces, mirrors, plane_first, first, last, vectors):
    """Give ghost nodes the values of their images, slots first..last-1; the transpose of ``fold``."""
    _reflect(nodes, faces, mirrors, plane_first, first, last, vectors, False)


@function()
def fold_held(nodes, faces, mirrors, plane_first, first, last, held):
    """``fold`` of vectors that keeps the records of the ghosts of closed faces in ``held``."""
    dim = len(faces)
    for a in range(dim):
        for plane in range(PLANES):
            begin, end = plane_first[PLANES * a + plane], plane_first[PLANES * a + plane + 1]
            if begin < end:
                face, of_plane = faces[a, min(plane, 1)], mirrors[begin:end]
                if face != PERIODIC:
                    face_impulses.hold(nodes, of_plane, _acting(face, a), first, last, held[begin:end])
                _reflect_plane(nodes, face, a, of_plane, dim, first, last, True, True)


@function()
def fill_counted(
    nodes, faces, mirrors, plane_first, last, solved, dt, place, cell_size, held, is_last, given, mapped
):
    """``fill`` of vectors, slots 1..last-1, that also counts the impulses of the faces.

    ``solved``: whether the momentum equation of the step of ``dt`` s has been solved. ``is_last``: whether
    this is the last filling of the step; if not, walls of the case act afterwards.
    """
    dim = len(faces)
    for step in range(dim):
        a = dim - 1 - step
        for plane in range(PLANES):
            begin, end = plane_first[PLANES * a + plane], plane_first[PLANES * a + plane + 1]
            if begin < end:
                side = min(plane, 1)
                face, of_plane, at, f = faces[a, side], mirrors[begin:end], place[begin:end], 2 * a + side
                acting, sign, out = _acting(face, a), _parity(face, a, dim, True), cell_size * (2 * side - 1)
                if face != PERIODIC and is_last:
                    face_impulses.count(
                        nodes, of_plane, acting, sign, a, out, at, held[begin:end], dt, given[f], mapped[f]
                    )
                elif face != PERIODIC:
                    face_impulses.count_overwritten(
                        nodes, of_plane, acting, sign, a, out, at, solved, False, mapped[f]
                    )
                    if solved:
                        face_impulses.count_overwritten(
                            nodes, of_plane, acting, sign, a, out, at, True, True, given[f]
                        )
                _reflect_plane(nodes, face, a, of_plane, dim, 1, last, True, False)


@function()
def _clear(sums):
    sums[:] = 0.0


@function()
def _constrain(nodes, faces, mirrors, plane_first, friction, solved, place, given):
    """Boundary conditions on the velocity and, once ``solved``, on its change.

    Where walls meet, a node has the conditions of all of them. The pushes of all Coulomb walls come first,
    then the other walls, then the drag of the Coulomb walls. So the result does not depend on the order of
    the axes.
    """
    dim = len(faces)
    grip = np.zeros(len(mirrors) if solved else 0)  # largest drag on each wall node, m/s
    for turn in range(3):
        for a in range(dim):
            for side in range(2):
                face, plane = faces[a, side], PLANES * a + side
                begin, end = plane_first[plane], plane_first[plane + 1]
                pushes = face in (FRICTION, RELEASING_STICK)
                of_plane, at, by = mirrors[begin:end], place[begin:end], given[2 * a + side]
                if turn == 0 and solved and pushes:
                    _push(nodes, dim, of_plane, a, 1 - 2 * side, friction[a, side], grip[begin:end], at, by)
                elif turn == 1 and face != OPEN and face != PERIODIC:
                    sticks = face in (STICK, RELEASING_STICK)
                    _hold(nodes, dim, of_plane, _acting(face, a), a, sticks, solved, at, by)
                elif turn == 2 and solved and face == FRICTION:
                    _drag(nodes, dim, of_plane, a, grip[begin:end], at, by)


@inline()
def _change(node, dim, d, change, solved, place, k, given):
    """Change a velocity along axis d and, once ``solved``, its change; count the impulse of the face."""
    face_impulses.add(given, dim, place, k, d, node[0] * change)
    if solved:
        node[1 + dim + d] += change
    node[1 + d] += change


@function()
def _push(nodes, dim, mirrors, a, inward, coefficient, grip, place, given):
    """A wall that pushes and does not pull; ``grip`` becomes the slip that friction can stop at each node.

    The momentum equation decides once in a step whether the wall pushes a touched node: it does if the
    velocity points into the wall. Until the next decision the normal velocity is held, whatever its sign. A
    wall that let go as soon as the mapped velocity points away would strain the last cell on approach but
    never on departure. With USF and MUSL this would add energy.
    """
    for k in range(len(mirrors)):
        node = nodes[mirrors[k, 2]]
        contacts, this = int(node[CONTACT]), PUSHED << a  # in a corner one wall may push and the other not
        push = -inward * node[1 + a]
        if push > 0.0 and contacts & TOUCHED << a:
            node[CONTACT] = contacts | this
            _change(node, dim, a, -node[1 + a], True, place, k, given)
            grip[k] = coefficient * push
        else:
            node[CONTACT] = contacts & ~this


@function()
def _hold(nodes, dim, mirrors, acting, a, sticks, solved, place, given):
    """Set the velocity of nodes where a face acts to zero: the normal part, or all of it if it ``sticks``."""
    for k in range(len(mirrors)):
        node = nodes[mirrors[k, 2]]
        if not acting or int(node[CONTACT]) & acting:
            for d in range(dim):
                if d == a or sticks:
                    _change(node, dim, d, -node[1 + d], solved, place, k, given)


@function()
def _drag(nodes, dim, mirrors, a, grip, place, given):
    """Coulomb's law: drag reduces the slip by at most coefficient × push, and never reverses it."""
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
                    _change(node, dim, d, -lost * node[1 + d], True, place, k, given)


@kernel()
def find_crowding(pairs, room, most, crowding, rows, tasks, faces, mirrors, plane_first):
    """Σ w / room, limited to 1 … ``most``, at all nodes; ghosts are added to their images.

    ``pairs`` is zero afterwards.
    """
    fold(pairs, faces, mirrors, plane_first, 0, 2, False)
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                crowding[i] = min(max(1.0, pairs[i, 0] / room[i]), most)
                pairs[i, 0] = pairs[i, 1] = 0.0


@kernel()
def relieve_pairs(pairs, crowding, rows, tasks, faces, mirrors, plane_first):
    """Σ w f / crowding at every node; ghosts are added to their images."""
    fold(pairs, faces, mirrors, plane_first, 0, 2, False)
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                pairs[i, 1] /= crowding[i]


@kernel()
def divide_pairs(pairs, average, rows, tasks, faces, mirrors, plane_first):
    """Σ w f / Σ w at every node, zero where there is no material; ghosts are folded in and filled back.

    ``pairs`` is zero afterwards, ready for the next average.
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
def momentum_to_velocity(
    nodes, rows, tasks, faces, mirrors, plane_first, friction, place, cell_size, held, walls_act, mapped
):
    """v = p / m, with the conditions on the faces, and the ghosts filled. Forces are not changed.

    ``walls_act``: whether walls of the case act afterwards. ``mapped`` becomes the impulses of the faces,
    without those through their ghosts, which are counted when the momentum equation is solved.
    """
    dim = len(faces)
    for t in prange(len(tasks) - 1):
        for r in range(tasks[t], tasks[t + 1]):
            for i in range(rows[r, 0], rows[r, 1]):
                m = nodes[i, 0]
                if m > 0.0:
                    for d in range(dim):
                        nodes[i, 1 + d] /= m
    _clear(mapped)
    _constrain(nodes, faces, mirrors, plane_first, friction, False, place, mapped)
    if walls_act:
        fill_counted(
            nodes, faces, mirrors, plane_first, 1 + dim, False, 0.0, place, cell_size, held, False, mapped,
            mapped,
        )  # fmt: skip
    else:
        fill(nodes, faces, mirrors, plane_first, 1, 1 + dim, True)


@kernel()
def solve_momentum(
    nodes, rows, tasks, faces, mirrors, plane_first, friction, place, cell_size, held, walls_act, given,
    mapped, dt,
):  # fmt: skip
    """Δv = dt f / m, v ← v + Δv, with the conditions on the faces, and the ghosts filled.

    Adds the impulses of the faces to ``given``, and those of the mapping through their ghosts to ``mapped``.
    """
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
    _constrain(nodes, faces, mirrors, plane_first, friction, True, place, given)
    # CONTACT, the last entry of a record, is filled too: a wall pushes a ghost in its plane if it pushes its
    # image.
    fill_counted(
        nodes, faces, mirrors, plane_first, CONTACT + 1, True, dt, place, cell_size, held, not walls_act,
        given, mapped,
    )  # fmt: skip
