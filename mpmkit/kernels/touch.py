"""Which nodes of the walls are touched in a step: those where material has reached the wall.

A particle has weight on the nodes of a wall when it is still up to a cell away. What stops it there stops it in
the air: see ``solver.touch``.
"""

from __future__ import annotations

from functools import cache

from numba import prange

from .compile import function, inline, kernel
from .nodes import PLANES, fold, is_wall
from .scatter import CONTACT, PUSHED, TOUCHED

REACH = 0.02
"""Gap, in cells, between a particle's box and a wall up to which they touch."""
FULL = 0.9
"""Crowding from which a node of a wall is touched, however far the boxes around it are from the wall."""
PUSHES = TOUCHED - PUSHED
"""The bits of all axes."""
TOUCHES = PUSHES * TOUCHED


@cache
def mark(dim: int, support: int):
    """The kernel that sets ``TOUCHED`` at the nodes of the walls, for a shape function of that support.

    ``mark(nodes, sums, strides, lower, walls, faces, mirrors, plane_first, tasks, base, weight, position,
    velocity, half_size, volume, room, cell_size, begins)`` marks a node for an axis if the box of a particle with
    weight on the node reaches the wall across that axis, or if the node is full: Σ V_p N_np > ``FULL`` V_n.
    Where material has not reached the wall, it has not been pushed either. When a run ``begins``, what rests on
    a wall is held to be pushed by it.

    ``walls[a, side]`` is the number of the nodes on a face that is a wall, and one that no node has where it is
    none. ``room`` is V_n of the nodes of the walls, one for each row of ``mirrors``. ``sums`` is scratch, ``(nodes,
    2)``; it must be zero, and is zero afterwards.
    """

    @kernel()
    def mark(
        nodes, sums, strides, lower, walls, faces, mirrors, plane_first, tasks, base, weight, position, velocity,
        half_size, volume, room, cell_size, begins,
    ):  # fmt: skip
        _forget(nodes, faces, mirrors, plane_first)
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(tasks.shape[0]):
                    for p in range(tasks[g, colour, task], tasks[g, colour, task + 1]):
                        near = False
                        for a in range(dim):
                            first = base[p, a]
                            near |= (first <= walls[a, 0]) & (walls[a, 0] < first + support)
                            near |= (first <= walls[a, 1]) & (walls[a, 1] < first + support)
                        if near:
                            _reach(
                                nodes, sums, strides, lower, walls, base, weight, position, velocity, half_size,
                                volume, cell_size, begins, p, dim, support,
                            )  # fmt: skip
        _settle(nodes, sums, faces, mirrors, plane_first, room)

    return mark


@inline()
def _reach(
    nodes, sums, strides, lower, walls, base, weight, position, velocity, half_size, volume, cell_size, begins,
    p, dim, support,
):  # fmt: skip
    """The share of a particle in the nodes of the walls that it has weight on."""
    reached = resting = 0  # bits of the axes across which its box reaches a wall, and of those where it rests there
    for a in range(dim):
        x, half = position[p, a], min(half_size[p, a], 0.5 * cell_size)
        for side in range(2):
            gap = abs(x - walls[a, side] * cell_size) - half
            if gap <= REACH * cell_size:
                reached |= 1 << 2 * a + side
                if begins and velocity[p, a] == 0.0:
                    resting |= 1 << 2 * a + side
    for n in range(support**dim):
        at, rest, w, bits, on_wall = 0, n, 1.0, 0, False
        for d in range(dim):
            a = dim - 1 - d
            k = rest % support
            rest //= support
            number = base[p, a] + k
            w *= weight[p, a, k]
            at += (number - lower[a]) * strides[a]
            for side in range(2):
                if number == walls[a, side]:
                    on_wall = True
                    if reached >> 2 * a + side & 1:
                        bits |= TOUCHED << a
                    if resting >> 2 * a + side & 1:
                        bits |= PUSHED << a
        if on_wall and w != 0.0:
            sums[at, 0] += volume[p] * w
            nodes[at, CONTACT] = int(nodes[at, CONTACT]) | bits


@function()
def _forget(nodes, faces, mirrors, plane_first):
    """No node is touched."""
    for a in range(len(faces)):
        for side in range(2):
            if is_wall(faces[a, side]):
                for k in range(plane_first[PLANES * a + side], plane_first[PLANES * a + side + 1]):
                    wall = mirrors[k, 2]
                    nodes[wall, CONTACT] = int(nodes[wall, CONTACT]) & PUSHES


@function()
def _settle(nodes, sums, faces, mirrors, plane_first, room):
    """Full nodes are touched; a ghost and its image are touched alike, and push only where they are touched."""
    dim = len(faces)
    fold(sums, faces, mirrors, plane_first, 0, 1, False)
    for a in range(dim):
        for k in range(plane_first[PLANES * a], plane_first[PLANES * (a + 1)]):
            ghost, image = mirrors[k, 0], mirrors[k, 1]
            nodes[image, CONTACT] = int(nodes[image, CONTACT]) | int(nodes[ghost, CONTACT]) & TOUCHES
    for a in range(dim):
        for side in range(2):
            if is_wall(faces[a, side]):
                for k in range(plane_first[PLANES * a + side], plane_first[PLANES * a + side + 1]):
                    wall = mirrors[k, 2]
                    if sums[wall, 0] > FULL * room[k]:
                        nodes[wall, CONTACT] = int(nodes[wall, CONTACT]) | TOUCHED << a
    for step in range(dim):
        a = dim - 1 - step
        for k in range(plane_first[PLANES * a], plane_first[PLANES * (a + 1)]):
            ghost, image = mirrors[k, 0], mirrors[k, 1]
            contacts = int(nodes[ghost, CONTACT]) & PUSHES | int(nodes[image, CONTACT]) & TOUCHES
            nodes[ghost, CONTACT] = contacts
    for k in range(len(mirrors)):
        wall = mirrors[k, 2]
        contacts = int(nodes[wall, CONTACT])
        nodes[wall, CONTACT] = contacts & (TOUCHES | contacts // TOUCHED)
        sums[wall, 0] = 0.0
