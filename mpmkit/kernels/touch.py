"""Finds the nodes of the walls that are touched in a step: those where material has reached the wall.

A particle has weight on the nodes of a wall already when it is still up to a cell away. If the wall acted
then, it would stop the particle in the air: see ``solver.touch``.
"""

from __future__ import annotations

from functools import cache

from numba import prange

from .compile import function, inline, kernel
from .nodes import PLANES, fold, is_wall
from .scatter import CONTACT, PUSHED, TOUCHED

REACH = 0.02
"""Largest gap, in cells, between a particle's box and a wall that touch."""
FULL = 0.9
"""Crowding from which a node of a wall is touched, for any distance of the boxes around it."""
NOWHERE = -(1 << 30)
"""Stands for the number of the nodes on a face that is not a wall; no node has this number."""
PUSHES = TOUCHED - PUSHED
"""The ``PUSHED`` bits of all axes."""
TOUCHES = PUSHES * TOUCHED


@cache
def mark(dim: int, support: int):
    """The kernel that sets ``TOUCHED`` at the nodes of the walls, for a shape function of that support.

    ``mark(nodes, sums, strides, lower, walls, faces, mirrors, plane_first, tasks, base, weight, position,
    velocity, half_size, volume, room, cell_size, begins)`` marks a node for an axis if the box of a
    particle with weight on the node reaches the wall across that axis, or if the node is full: Σ V_p N_np >
    ``FULL`` V_n. Where material has not reached the wall, it is not pushed either. When a run ``begins``,
    material at rest on a wall is assumed to be pushed by it.

    ``walls[a, side]`` is the number of the nodes on a face, or ``NOWHERE`` if the face is not a wall.
    ``room`` is V_n of the nodes of the walls, one for each row of ``mirrors``. ``sums`` is scratch, ``(nodes,
    2)``, for Σ V_p N_np and for bits; it must be zero before, and is zero afterwards.
    """
    planes = support if dim == 3 else 1

    @inline()
    def _reach(
        sums, strides, lower, walls, base, weight, position, velocity, half_size, volume, cell_size, begins,
        p, a, wall, k,
    ):  # fmt: skip
        """The share of a particle in the nodes of the wall that is k nodes from its first along axis a."""
        V = volume[p] * weight[p, a, k]
        if V == 0.0:
            return
        half = min(half_size[p, a], 0.5 * cell_size)  # the part of the box that the weights see
        bits = 0
        if abs(position[p, a] - wall * cell_size) - half <= REACH * cell_size:
            bits = TOUCHED << a
            if begins and velocity[p, a] == 0.0:
                bits |= PUSHED << a
        b, c = (a + 1) % dim, (a + 2) % dim  # the axes along the wall; in the plane only the first
        first = (wall - lower[a]) * strides[a] + (base[p, b] - lower[b]) * strides[b]
        if dim == 3:
            first += (base[p, c] - lower[c]) * strides[c]
        for i in range(support):
            i_counts = b > a or not _on(walls, b, base[p, b] + i)
            for j in range(planes):
                w, at, counts = V * weight[p, b, i], first + i * strides[b], i_counts
                if dim == 3:
                    w *= weight[p, c, j]
                    at += j * strides[c]
                    counts &= c > a or not _on(walls, c, base[p, c] + j)
                if counts:  # a node on two walls is visited twice, and must count once
                    sums[at, 0] += w
                if bits and w != 0.0 and int(sums[at, 1]) & bits != bits:
                    sums[at, 1] = int(sums[at, 1]) | bits

    @kernel()
    def mark(
        nodes, sums, strides, lower, walls, faces, mirrors, plane_first, tasks, base, weight, position,
        velocity, half_size, volume, room, cell_size, begins,
    ):  # fmt: skip
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(tasks.shape[0]):
                    begin, end = tasks[g, colour, task], tasks[g, colour, task + 1]
                    for a in range(dim):
                        for side in range(2):
                            wall = walls[a, side]
                            if wall != NOWHERE:
                                for p in range(begin, end):
                                    k = wall - base[p, a]
                                    if 0 <= k < support:
                                        _reach(
                                            sums, strides, lower, walls, base, weight, position, velocity,
                                            half_size, volume, cell_size, begins, p, a, wall, k,
                                        )  # fmt: skip
        _settle(nodes, sums, faces, mirrors, plane_first, room)

    return mark


@inline()
def _on(walls, a, number):
    """Whether nodes with this number along an axis lie on one of its walls."""
    return number == walls[a, 0] or number == walls[a, 1]


@function()
def _settle(nodes, sums, faces, mirrors, plane_first, room):
    """Full nodes are touched; a ghost and its image have the same bits; an untouched node is not pushed."""
    dim = len(faces)
    fold(sums, faces, mirrors, plane_first, 0, 1, False)
    for a in range(dim):
        for k in range(plane_first[PLANES * a], plane_first[PLANES * (a + 1)]):
            ghost, image = mirrors[k, 0], mirrors[k, 1]
            if sums[ghost, 1] != 0.0:
                sums[image, 1] = int(sums[image, 1]) | int(sums[ghost, 1])
    for a in range(dim):
        for side in range(2):
            if is_wall(faces[a, side]):
                for k in range(plane_first[PLANES * a + side], plane_first[PLANES * a + side + 1]):
                    wall = mirrors[k, 2]
                    if sums[wall, 0] > FULL * room[k]:
                        sums[wall, 1] = int(sums[wall, 1]) | TOUCHED << a
    for step in range(dim):
        a = dim - 1 - step
        for k in range(plane_first[PLANES * a], plane_first[PLANES * (a + 1)]):
            ghost, image = mirrors[k, 0], mirrors[k, 1]
            sums[ghost, 1] = sums[image, 1]
    for plane in range(PLANES * dim):
        if is_wall(faces[plane // PLANES, min(plane % PLANES, 1)]):
            for k in range(plane_first[plane], plane_first[plane + 1]):
                wall = mirrors[k, 2]
                found, pushed = int(sums[wall, 1]), int(nodes[wall, CONTACT]) & PUSHES
                touched = found & TOUCHES
                nodes[wall, CONTACT] = touched | (pushed | found) & touched // TOUCHED
    for k in range(len(mirrors)):
        for node in mirrors[k]:
            sums[node, 0] = sums[node, 1] = 0.0
