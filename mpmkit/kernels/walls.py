"""Walls that stand anywhere: nodes at which they act, ghosts beyond them, and what passes between the two.

A node is *at* a wall if it is within half a cell of it, to either side: there is one for each cell of wall,
however the wall lies. The velocity of the material at the wall is that of the line through the node and an
image, one cell further in along the normal,

    v_wall = a v_node + b v_image,   a = 1 + d,  b = -d,

with the signed distance d of the node, in cells; the velocity of the image is interpolated between the nodes
around it. What a wall does is an impulse λ at that place. The nodes share it by the same weights C: the change
C λ / m of each is the smallest, measured by its energy, that gives the velocity at the wall its due. A wall
that lies on the nodes has a = 1 and b = 0, and acts on these nodes alone.

A *ghost* is a node more than half a cell behind the wall. It continues the velocity as the mirrored scene
would, v_ghost = w + R (v_image - w), with the image at the same distance in front of the wall. What particles
put on it is folded onto the nodes around the image with the weights by which it is filled back: the two are
transposes of each other. R reverses the normal part (mirror), or all of it (odd). Averages of scalars fold and
fill all nodes behind the wall in the same way.

What was tried otherwise, and what it gave, is in docs/findings.md. Walls are surfaces: there are few nodes at
them, and these loops run in one thread.
"""

from __future__ import annotations

import numpy as np

from .compile import function

FAR = 1e300
"""Distance of nodes that are not near a wall."""
AT, GHOST = 0.5, 2.0
"""Cells from a wall within which a node is at it, and behind it within which it can be a ghost."""
NEAR = 2.8
"""Cells from a wall within which a particle may lie so that nodes of its cell must know their distance."""
TOUCH = 0.02
"""Cells from a wall within which a box touches it."""
LEAST, NONE = 0.1, -1.0
"""Least weight of the nodes around an image that particles can reach; the first weight where there is less."""


@function()
def _corners(place, lower, shape, strides, active, taken, index, weight):
    """Nodes around a place, in cells from the grid's corner, and their weights, which add up to one.

    Nodes that no particle can reach, and those in ``taken``, have none. Whether any is left.
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
    at, number, distance, normal, lower, shape, strides, active, taken, at_wall, ghost, index, weight,
    foot, foot_weight,
):  # fmt: skip
    """Sort the nodes near a wall into those at it and ghosts, with the nodes around the image of each.

    Args:
        at: (k,) the nodes, by their place in the window.
        number: (k, dim) their numbers along the axes.
        distance, normal: (k,) in cells and (k, dim).
        lower, shape, strides: of the window.
        active: (nodes,) whether particles can reach a node.
        taken: (nodes,) scratch, all false: becomes true at ghosts.
        at_wall, ghost: (k,) which of the k are at the wall, and which are ghosts (out).
        index, weight: (k, 2^dim) of the image of each (out).
        foot, foot_weight: (k, 2^dim) nodes at the wall around the foot of each ghost (out).

    Returns:
        How many are at the wall, and how many are ghosts.
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
        _corners(place, lower, shape, strides, active, taken, index[k], weight[k])
    for j in range(ghosts):
        k = ghost[j]
        for a in range(dim):
            place[a] = number[k, a] - 2.0 * distance[k] * normal[k, a]
        _corners(place, lower, shape, strides, active, taken, index[k], weight[k])
    for k in range(len(at)):
        taken[at[k]] = 1
    for j in range(count):
        taken[at[at_wall[j]]] = 0
    for j in range(ghosts):
        k = ghost[j]
        for a in range(dim):
            place[a] = number[k, a] - distance[k] * normal[k, a]
        _corners(place, lower, shape, strides, active, taken, foot[k], foot_weight[k])
    for k in range(len(at)):
        taken[at[k]] = 0
    for j in range(ghosts):
        taken[at[ghost[j]]] = 1
    return count, ghosts


@function()
def press(ghost, normal, foot, foot_weight, held, dt, pressed):
    """Add to ``pressed`` (nodes,) of the nodes at the wall what it gives along its normal by the ghosts, N s:
    dt (R f - f)·n = -2 dt f·n of each."""
    dim = normal.shape[1]
    for k in ghost:
        if foot_weight[k, 0] >= 0.0:
            given = 0.0
            for a in range(dim):
                given -= 2.0 * dt * held[k, 1 + dim + a] * normal[k, a]
            for c in range(foot.shape[1]):
                pressed[foot[k, c]] += foot_weight[k, c] * given


@function()
def _distance(x, inverse, lower, strides, distance, slope):
    """Distance of a place from the wall, in cells, and its slope along each axis (out); ``FAR`` if it is far.

    It is interpolated between the nodes of the cell.
    """
    dim = len(x)
    first = 0
    for a in range(dim):
        first += (int(np.floor(x[a] * inverse)) - lower[a]) * strides[a]
    if not distance[first] < NEAR:
        return FAR
    d = 0.0
    slope[:] = 0.0
    for k in range(1 << dim):
        at, w = first, 1.0
        for a in range(dim):
            part = x[a] * inverse - np.floor(x[a] * inverse)
            at += (k >> a & 1) * strides[a]
            w *= part if k >> a & 1 else 1.0 - part
        d += w * distance[at]
        for a in range(dim):
            s = distance[at] if k >> a & 1 else -distance[at]
            for e in range(dim):
                if e != a:
                    part = x[e] * inverse - np.floor(x[e] * inverse)
                    s *= part if k >> e & 1 else 1.0 - part
            slope[a] += s
    return d


@function()
def keep_out(position, cell_size, lower, strides, distance):
    """Put particles that have come into the wall back to its surface, along the normal; how many."""
    inverse, count = 1 / cell_size, 0
    slope = np.empty(position.shape[1])
    for p in range(len(position)):
        d = _distance(position[p], inverse, lower, strides, distance, slope)
        if d < 0.0:
            square = (slope * slope).sum()
            if square > 0.25:  # in the middle of a thin wall no side is nearer
                for a in range(len(slope)):
                    position[p, a] -= d * slope[a] / square * cell_size
                count += 1
    return count


@function()
def mark_touched(position, half_size, inverse, base, weight, lower, strides, distance, touched):
    """Mark the nodes on which a particle has weight whose box reaches the wall.

    Args:
        distance: (nodes,) of the window, in cells; ``FAR`` away from the wall.
        touched: (nodes,) uint8 (out).
    """
    n, dim = position.shape
    support = weight.shape[2]
    planes = support if dim == 3 else 1
    slope = np.empty(dim)
    for p in range(n):
        d = _distance(position[p], inverse, lower, strides, distance, slope)
        reach = TOUCH
        for a in range(dim):
            reach += half_size[p, a] * inverse * abs(slope[a])
        if not d <= reach:
            continue
        first = 0
        for a in range(dim):
            first += (base[p, a] - lower[a]) * strides[a]
        for i in range(support):
            for j in range(planes):
                row = first + i * strides[0] + j * strides[1] * (dim - 2)
                w = weight[p, 0, i] * (weight[p, 1, j] if dim == 3 else 1.0)
                for k in range(support):
                    if w * weight[p, dim - 1, k] > 0.0:
                        touched[row + k] = 1


@function()
def _reflect(vector, m, w, normal, odd, out):
    """out = m w + R (vector - m w): the part against the wall reversed along the normal, or all of it."""
    along = 0.0
    for a in range(len(normal)):
        along += (vector[a] - m * w[a]) * normal[a]
    for a in range(len(normal)):
        out[a] = 2.0 * m * w[a] - vector[a] if odd else vector[a] - 2.0 * along * normal[a]


@function()
def fold(nodes, ghost, at, normal, wall_velocity, index, weight, touched, odd, momentum, forces, held):
    """Add what lies on touched ghosts to the nodes around their images, and clear the ghosts.

    ``held`` (k, 1 + 2 dim) keeps mass, momentum and force of each, for its share in the force of the wall.
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
def fill(nodes, ghost, at, normal, wall_velocity, index, weight, touched, odd, solved, dt, held, impulse):
    """Give touched ghosts the velocity of their images, mirrored; the transpose of ``fold``.

    ``impulse`` (k, dim) gets what the wall has given by each ghost, N s, with m, p and f of the ghost: in
    mapping m (v_ghost - v_image) + R p - p, and once ``solved`` m (Δv_ghost - Δv_image) + dt (R f - f).
    """
    dim = normal.shape[1]
    v, change, folded, none = np.empty(dim), np.empty(dim), np.empty(dim), np.zeros(dim)
    for k in ghost:
        g = at[k]
        impulse[k, :] = 0.0
        if not touched[g] or weight[k, 0] < 0.0:
            continue
        v[:] = 0.0
        change[:] = 0.0
        for c in range(index.shape[1]):
            for a in range(dim):
                v[a] += weight[k, c] * nodes[index[k, c], 1 + a]
                change[a] += weight[k, c] * nodes[index[k, c], 1 + dim + a]
        m = held[k, 0]
        _reflect(v, 1.0, wall_velocity[k], normal[k], odd, nodes[g, 1 : 1 + dim])
        if solved:
            _reflect(change, 0.0, none, normal[k], odd, nodes[g, 1 + dim : 1 + 2 * dim])
            _reflect(held[k, 1 + dim :], 0.0, none, normal[k], odd, folded)
            for a in range(dim):
                impulse[k, a] = m * (nodes[g, 1 + dim + a] - change[a]) + dt * (folded[a] - held[k, 1 + dim + a])
        else:
            _reflect(held[k, 1 : 1 + dim], m, wall_velocity[k], normal[k], odd, folded)
            for a in range(dim):
                impulse[k, a] = m * (nodes[g, 1 + a] - v[a]) + folded[a] - held[k, 1 + a]


@function()
def at_wall_velocities(nodes, at_wall, at, distance, normal, index, weight, free, acting, share, stiffness, velocity, inner):
    """Velocity of the material at a wall, and how easily it is changed there.

    Args:
        free: (k,) bits of the axes along which no face of the grid holds the node.
        acting: (k,) which nodes have mass (out).
        share: (k, 1 + 2^dim) weights C of the node and of those around its image (out).
        stiffness: (k, dim) Σ C² / m along each axis, 1/kg (out).
        velocity, inner: (k, dim) at the wall and at the image (out).

    Returns:
        How many have mass.
    """
    dim = normal.shape[1]
    corners = index.shape[1]
    count = 0
    for k in at_wall:
        g = at[k]
        if not nodes[g, 0] > 0.0:
            continue
        total = 0.0
        for c in range(corners):  # no weight is above 0 where there is no image
            if weight[k, c] > 0.0 and nodes[index[k, c], 0] > 0.0:
                total += weight[k, c]
        d = distance[k]
        a, b = (1.0 + d, -d) if total > 0.0 else (1.0, 0.0)  # D - d = 1 cell
        share[count, 0] = a
        for e in range(dim):
            velocity[count, e] = a * nodes[g, 1 + e]
            inner[count, e] = 0.0 if total > 0.0 else nodes[g, 1 + e]
            stiffness[count, e] = 0.0
        own = a
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
                        if free[i] >> e & 1:
                            stiffness[count, e] += (b * part) ** 2 / nodes[i, 0]
        for e in range(dim):
            if free[g] >> e & 1:
                stiffness[count, e] += own * own / nodes[g, 0]
        acting[count] = k
        count += 1
    return count


@function()
def _give(nodes, g, index, share, free, dim, impulse, solved):
    """An impulse at the wall, shared among the nodes."""
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
def push(
    nodes, acting, at, normal, index, free, share, stiffness, before, after, whole, pulls, sweeps, solved, impulse
):
    """Give the nodes the impulses that change the velocities at the wall from ``before`` to ``after``.

    Nodes share neighbours, so that one impulse disturbs the next: what the wall holds is put right in some
    sweeps, the normal part or, with ``whole``, all of it. Without ``pulls`` no impulse may come to pull.

    Returns in ``impulse`` (k, dim), N s.
    """
    dim = normal.shape[1]
    count = len(acting)
    step = np.empty(dim)
    held = np.zeros(count, dtype=np.uint8)
    for j in range(count):
        k = acting[j]
        resist = along = 0.0
        for e in range(dim):
            resist += normal[k, e] ** 2 * stiffness[j, e]
            along += normal[k, e] * (after[j, e] - before[j, e])
            held[j] |= after[j, e] != before[j, e]
        for e in range(dim):
            across = after[j, e] - before[j, e] - along * normal[k, e]
            step[e] = across / stiffness[j, e] if stiffness[j, e] > 0.0 else 0.0
            if resist > 0.0:
                step[e] += along / resist * normal[k, e]
            impulse[j, e] = step[e]
        if held[j]:
            _give(nodes, at[k], index[k], share[j], free, dim, step, solved)
    velocity = np.empty(dim)
    for _ in range(sweeps):
        for j in range(count):
            if not held[j]:
                continue
            k = acting[j]
            _velocity(nodes, at[k], index[k], share[j], dim, velocity)
            resist = along = pushed = 0.0
            for e in range(dim):
                resist += normal[k, e] ** 2 * stiffness[j, e]
                along += normal[k, e] * (after[j, e] - velocity[e])
                pushed += normal[k, e] * impulse[j, e]
            if whole:
                for e in range(dim):
                    step[e] = (after[j, e] - velocity[e]) / stiffness[j, e] if stiffness[j, e] > 0.0 else 0.0
            else:
                more = along / resist if resist > 0.0 else 0.0
                if not pulls:
                    more = max(more, -pushed)
                for e in range(dim):
                    step[e] = more * normal[k, e]
            for e in range(dim):
                impulse[j, e] += step[e]
            _give(nodes, at[k], index[k], share[j], free, dim, step, solved)


@function()
def find_images(at, number, distance, normal, lower, shape, strides, active, taken, behind, index, weight):
    """Nodes behind a wall, and the nodes around the image of each: for averages of scalars."""
    dim = number.shape[1]
    count = 0
    place = np.empty(dim)
    for k in range(len(at)):
        if active[at[k]] and -GHOST < distance[k] < 0.0:
            for a in range(dim):
                place[a] = number[k, a] - 2.0 * distance[k] * normal[k, a]
            if _corners(place, lower, shape, strides, active, taken, index[k], weight[k]):
                behind[count] = k
                count += 1
    return count


@function()
def fold_pairs(pairs, behind, at, index, weight, touched, held):
    """Add the sums of an average at touched ghosts to the nodes around their images, and clear them."""
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


@function()
def add_up(impulse, nodes, place, distance, normal, wall_velocity, sums):
    """Add impulses (n, dim), N s, of some ``nodes`` to the sums of a wall: itself, its moment, its work.

    The moment is about the origin of the scene, N m s: x × λ in 3-D, and its part out of the plane, about
    the axis y, in two dimensions. The work is λ·w, J.
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
