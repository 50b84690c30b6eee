"""The action of a wall, at any place and angle, on the nodes at it.

The velocity of the material at the wall is that of the line through a node and its image,

    v_wall = a v_node + b v_image,   a = 1 + d,  b = -d,

with the signed distance d of the node, in cells. The wall gives an impulse λ at that place. The nodes share
it with the same weights C: the change C λ / m of each node has the least energy of all changes that give the
required velocity at the wall. A wall that lies on nodes has a = 1 and b = 0, and acts only on these nodes.

docs/findings.md has the alternatives that were tried, with their results.
"""

from __future__ import annotations

import numpy as np

from .compile import function
from .face_impulses import add
from .nodes import RELEASING_STICK, STICK, holds
from .scatter import CONTACT

HELD, NONE = 0.1, 1e-9
"""Parts of Σ C² / m: the smallest that counts, and the one below which no axis is free."""


@function()
def find_free_axes(nodes, at, faces, dim, free):
    """Write to ``free`` (nodes,), for the nodes ``at``, the bits of the axes along which no face
    of the grid holds them.

    ``faces`` (nodes, dim) has the code of the face across each axis on which a node lies.
    """
    for g in at:
        bits = (1 << dim) - 1
        contact = int(nodes[g, CONTACT])
        for a in range(dim):
            if holds(faces[g, a], contact, a):
                bits &= 0 if faces[g, a] in (STICK, RELEASING_STICK) else ~(1 << a)
        free[g] = bits


@function()
def at_wall_velocities(
    nodes, at_wall, at, distance, normal, index, weight, free, acting, share, inverse_mass, velocity, inner
):
    """Velocity of the material at a wall, and the inverse of the mass on which an impulse acts there.

    Args:
        free: (k,) bits of the axes along which no face of the grid holds the node.
        acting: (k,) which nodes have mass (out).
        share: (k, 1 + 2^dim) weights C of the node and of those around its image (out).
        inverse_mass: (k, dim) Σ C² / m along each axis, 1/kg (out): the velocity at the wall changes by
            this times the impulse there. The sum is over the nodes that no face holds, but it is at least
            ``HELD`` times the sum over all nodes. Without this limit, a free node with a small weight would
            get a very large velocity where a face holds the other nodes.
        velocity, inner: (k, dim) at the wall and at the image (out).

    Returns:
        The number of nodes that have mass.
    """
    dim = normal.shape[1]
    corners = index.shape[1]
    whole = np.empty(dim)
    count = 0
    for k in at_wall:
        g = at[k]
        if not nodes[g, 0] > 0.0:
            continue
        total = 0.0
        for c in range(corners):  # without an image, no weight is above 0
            if weight[k, c] > 0.0 and nodes[index[k, c], 0] > 0.0:
                total += weight[k, c]
        d = distance[k]
        a, b = (1.0 + d, -d) if total > 0.0 else (1.0, 0.0)  # D - d = 1 cell
        share[count, 0] = a
        for e in range(dim):
            velocity[count, e] = a * nodes[g, 1 + e]
            inner[count, e] = 0.0 if total > 0.0 else nodes[g, 1 + e]
            inverse_mass[count, e] = 0.0
        own, whole[:] = a, 0.0
        for c in range(corners):
            i = index[k, c]
            part = 0.0
            if total > 0.0 and weight[k, c] > 0.0 and nodes[i, 0] > 0.0:
                part = weight[k, c] / total
            share[count, 1 + c] = b * part
            for e in range(dim):
                velocity[count, e] += b * part * nodes[i, 1 + e]
                inner[count, e] += part * nodes[i, 1 + e]
            if part > 0.0:
                if i == g:
                    own += b * part
                else:
                    for e in range(dim):
                        whole[e] += (b * part) ** 2 / nodes[i, 0]
                        if free[i] >> e & 1:
                            inverse_mass[count, e] += (b * part) ** 2 / nodes[i, 0]
        for e in range(dim):
            whole[e] += own * own / nodes[g, 0]
            if free[g] >> e & 1:
                inverse_mass[count, e] += own * own / nodes[g, 0]
            if inverse_mass[count, e] < HELD * whole[e]:
                inverse_mass[count, e] = HELD * whole[e] if inverse_mass[count, e] > NONE * whole[e] else 0.0
        acting[count] = k
        count += 1
    return count


@function()
def _give(nodes, g, index, share, free, dim, impulse, solved):
    """Share an impulse at the wall among the nodes."""
    for c in range(len(share)):
        if share[c] != 0.0:
            i = g if c == 0 else index[c - 1]
            for e in range(dim):
                if free[i] >> e & 1:
                    change = share[c] * impulse[e] / nodes[i, 0]
                    nodes[i, 1 + e] += change
                    if solved:
                        nodes[i, 1 + dim + e] += change


@function()
def _velocity(nodes, g, index, share, dim, velocity):
    for e in range(dim):
        velocity[e] = share[0] * nodes[g, 1 + e]
    for c in range(1, len(share)):
        if share[c] != 0.0:
            for e in range(dim):
                velocity[e] += share[c] * nodes[index[c - 1], 1 + e]


@function()
def give(nodes, acting, at, normal, index, free, share, inverse_mass, before, after, solved, impulse, held):
    """Give the nodes the impulses that change the velocities at the wall from ``before`` to ``after``.

    Args:
        impulse: (k, dim), N s, the impulses (out).
        held: (k,) whether the velocity must change there (out), uint8.
    """
    dim = normal.shape[1]
    for j in range(len(acting)):
        k = acting[j]
        normal_inverse_mass = along = 0.0
        held[j] = 0
        for e in range(dim):
            normal_inverse_mass += normal[k, e] ** 2 * inverse_mass[j, e]
            along += normal[k, e] * (after[j, e] - before[j, e])
            held[j] |= after[j, e] != before[j, e]
        for e in range(dim):
            across = after[j, e] - before[j, e] - along * normal[k, e]
            impulse[j, e] = across / inverse_mass[j, e] if inverse_mass[j, e] > 0.0 else 0.0
            if normal_inverse_mass > 0.0:
                impulse[j, e] += along / normal_inverse_mass * normal[k, e]
        if held[j]:
            _give(nodes, at[k], index[k], share[j], free, dim, impulse[j], solved)


@function()
def sweep(
    nodes, acting, at, normal, index, free, share, inverse_mass, after, whole, pulls, backwards, solved,
    impulse, held,
):  # fmt: skip
    """Correct the velocities of the places that the wall holds to ``after`` again, one place after the other.

    The places share nodes with each other and with those of other walls, so that each impulse changes the
    velocity of its neighbours. The normal part is corrected or, with ``whole``, the whole vector. Without
    ``pulls``, no sum of impulses may become a pull. Sweeps go forwards and backwards in turn. Each correction
    is a projection in the metric of the masses, and the product of the corrections is its own transpose only
    if their order is symmetric. Otherwise the work of the stress is not recovered, and material that sticks
    in a corner of two walls oscillates with growing amplitude under FLIP.
    """
    dim = normal.shape[1]
    count = len(acting)
    step, velocity = np.empty(dim), np.empty(dim)
    for turn in range(count):
        j = count - 1 - turn if backwards else turn
        if not held[j]:
            continue
        k = acting[j]
        _velocity(nodes, at[k], index[k], share[j], dim, velocity)
        normal_inverse_mass = along = pushed = 0.0
        for e in range(dim):
            normal_inverse_mass += normal[k, e] ** 2 * inverse_mass[j, e]
            along += normal[k, e] * (after[j, e] - velocity[e])
            pushed += normal[k, e] * impulse[j, e]
        if whole:
            for e in range(dim):
                step[e] = (
                    (after[j, e] - velocity[e]) / inverse_mass[j, e] if inverse_mass[j, e] > 0.0 else 0.0
                )
        else:
            more = along / normal_inverse_mass if normal_inverse_mass > 0.0 else 0.0
            if not pulls:
                more = max(more, -pushed)
            for e in range(dim):
                step[e] = more * normal[k, e]
        for e in range(dim):
            impulse[j, e] += step[e]
        _give(nodes, at[k], index[k], share[j], free, dim, step, solved)


@function()
def add_up(impulse, nodes, place, distance, normal, wall_velocity, sums):
    """Add the impulses (n, dim), N s, at some ``nodes``, their moments and their work to the sums of a wall.

    The moment is about the origin of the scene, N m s: x × λ in 3-D, and its component out of the plane,
    about the axis y, in two dimensions. The work is λ·w, J.
    """
    dim = impulse.shape[1]
    turns = len(sums) - dim - 1
    x = np.empty(dim)
    for j in range(len(nodes)):
        k = nodes[j]
        for a in range(dim):
            x[a] = place[k, a] - distance[k] * normal[k, a]
            sums[a] += impulse[j, a]
            sums[dim + turns] += impulse[j, a] * wall_velocity[k, a]
        if dim == 2:
            sums[dim] += x[1] * impulse[j, 0] - x[0] * impulse[j, 1]
        else:
            for a in range(3):
                b, c = (a + 1) % 3, (a + 2) % 3
                sums[3 + a] += x[b] * impulse[j, c] - x[c] * impulse[j, b]


@function()
def _holder(faces, contact, e):
    """The axis whose face holds a node along axis e: e itself, or that of a face to which the node sticks."""
    if not holds(faces[e], contact, e):
        for a in range(len(faces)):
            if faces[a] in (STICK, RELEASING_STICK) and holds(faces[a], contact, a):
                return a
    return e


@function()
def add_up_held(impulse, nodes, acting, at, index, share, free, faces, sides, places, of_faces):
    """Add the impulses of faces that hold nodes against a wall: the shares of the wall that these nodes do
    not take.

    Args:
        impulse: (n, dim) of the wall at the ``acting`` nodes, N s.
        faces, sides: (nodes, dim) code of the face across each axis on which a node lies, and its side.
        places: (nodes, dim) positions of the nodes, m.
        of_faces: (2 dim, ...) sums of the faces, see ``face_impulses``.
    """
    dim = impulse.shape[1]
    for j in range(len(acting)):
        k = acting[j]
        for c in range(share.shape[1]):
            i = at[k] if c == 0 else index[k, c - 1]
            if share[j, c] == 0.0 or free[i] == (1 << dim) - 1:
                continue
            for e in range(dim):
                if not free[i] >> e & 1:
                    a = _holder(faces[i], int(nodes[i, CONTACT]), e)
                    add(of_faces[2 * a + sides[i, a]], dim, places, i, e, -share[j, c] * impulse[j, e])
