"""The nodes of a wall at any place and angle: those at it, the ghosts behind it, and their images.

A node is *at* a wall if it is within half a cell of it, on either side: about one node for each cell of wall,
at any angle. Its image is one cell further inside along the normal. A *ghost* is a node more than half a cell
behind the wall. Its image is at the same distance in front of the wall. Values at an image are interpolated
from the nodes around it.
"""

from __future__ import annotations

import numpy as np

from .compile import function

FAR = 1e300
"""Distance of nodes that are not near a wall."""
AT, GHOST = 0.5, 2.0
"""Largest distance of a node at a wall, and largest depth of a ghost behind it, in cells."""
LEAST, NONE = 0.1, -1.0
"""Smallest sum of the weights around an image; the first weight is set to ``NONE`` if the sum is smaller."""


@function()
def _corners(place, lower, shape, strides, active, taken, index, weight):
    """Nodes around a place, given in cells from the grid's corner, and their weights, whose sum is one.

    Nodes that no particle can reach, and those in ``taken``, have no weight. Returns whether enough nodes are
    left.
    """
    dim = len(place)
    total = 0.0
    for k in range(1 << dim):
        at, w, inside = 0, 1.0, True
        for a in range(dim):
            first = int(np.floor(place[a]))
            part = place[a] - first
            bit = k >> a & 1
            along = first + bit - lower[a]
            w *= part if bit else 1.0 - part
            inside = inside and 0 <= along < shape[a]
            at += along * strides[a]
        if not inside or w < 1e-12 or not active[at] or taken[at]:
            index[k], weight[k] = 0, 0.0
        else:
            index[k], weight[k] = at, w
            total += w
    if total < LEAST:
        weight[:] = 0.0
        weight[0] = NONE
        return False
    for k in range(1 << dim):
        weight[k] /= total
    return True


@function()
def find_nodes(
    at, number, distance, normal, lower, shape, strides, active, inside, taken, at_wall, ghost, index, weight,
    foot, foot_weight,
):  # fmt: skip
    """Divide the nodes near a wall into those at it and ghosts; find the nodes around the image of each.

    Args:
        at: (k,) indices of the nodes in the window.
        number: (k, dim) their numbers along the axes.
        distance, normal: (k,) in cells and (k, dim).
        lower, shape, strides: of the window.
        active: (nodes,) whether particles can reach a node.
        inside: (nodes,) the same, without the nodes behind a face of the grid, which belong to its mirror.
        taken: (nodes,) scratch, all false: becomes true at ghosts.
        at_wall, ghost: (k,) which of the k are at the wall, and which are ghosts (out).
        index, weight: (k, 2^dim) of the image of each (out).
        foot, foot_weight: (k, 2^dim) nodes at the wall around the foot of each ghost (out).

    Returns:
        The number of nodes at the wall, and the number of ghosts.
    """
    dim = number.shape[1]
    count = ghosts = 0
    for k in range(len(at)):
        if active[at[k]]:
            if -GHOST < distance[k] <= -AT:
                ghost[ghosts] = k
                ghosts += 1
                taken[at[k]] = True
            elif -AT < distance[k] <= AT:
                at_wall[count] = k
                count += 1
    place = np.empty(dim)
    for j in range(count):
        k = at_wall[j]
        for a in range(dim):
            place[a] = number[k, a] + normal[k, a]
        _corners(place, lower, shape, strides, inside, taken, index[k], weight[k])
    for j in range(ghosts):
        k = ghost[j]
        for a in range(dim):
            place[a] = number[k, a] - 2.0 * distance[k] * normal[k, a]
        _corners(place, lower, shape, strides, inside, taken, index[k], weight[k])
    for k in range(len(at)):
        taken[at[k]] = 1
    for j in range(count):
        taken[at[at_wall[j]]] = 0
    for j in range(ghosts):
        k = ghost[j]
        for a in range(dim):
            place[a] = number[k, a] - distance[k] * normal[k, a]
        _corners(place, lower, shape, strides, inside, taken, foot[k], foot_weight[k])
    for k in range(len(at)):
        taken[at[k]] = 0
    for j in range(ghosts):
        taken[at[ghost[j]]] = 1
    return count, ghosts


@function()
def find_images(
    at, number, distance, normal, lower, shape, strides, active, inside, taken, behind, index, weight
):
    """Find the nodes behind a wall, and the nodes around the image of each, for averages of scalars."""
    dim = number.shape[1]
    count = 0
    place = np.empty(dim)
    for k in range(len(at)):
        if active[at[k]] and -GHOST < distance[k] < 0.0:
            for a in range(dim):
                place[a] = number[k, a] - 2.0 * distance[k] * normal[k, a]
            if _corners(place, lower, shape, strides, inside, taken, index[k], weight[k]):
                behind[count] = k
                count += 1
    return count
