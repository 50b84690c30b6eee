"""Particles to nodes (P2G).

Particles are kept in blocks of cells. Blocks of one colour touch no common node, so that each colour is
scattered in parallel without a race, in an order that does not depend on the number of threads. A node is a
record of ``NODE`` doubles: mass, momentum (dim), force (dim), and at ``CONTACT`` the bits of contact with
walls. A particle adds one vector to each record. The vector is built up axis by axis: factors that do not
depend on the innermost axis are multiplied before the loop over it.
"""

from __future__ import annotations

from functools import cache

from numba import prange

from .compile import inline, kernel
from .vectors import (
    LANES,
    lane,
    load,
    load_first,
    load_twice,
    multiply,
    pack,
    picker,
    plus,
    plus_product,
    scale,
    spread,
    store,
    store_half,
    zero,
)

NODE = LANES
"""Doubles in a node's record: one cache line, one vector."""
CONTACT = NODE - 1
"""Entry of a record that holds a whole number, a sum of bits. A node lies on at most one face of an axis."""
PUSHED, TOUCHED = 1, 8
"""The bits of axis 0; those of axis a are ``PUSHED << a`` and ``TOUCHED << a``. They say whether the wall
pushed the node when the momentum equation was last solved, and whether material has reached the wall there in
this step."""
PAIR = 2
"""Doubles in a node's record of an average: measure and measure × value."""
LARGEST_SUPPORT = LANES // PAIR
"""Nodes along an axis that a shape function may touch: a row of pairs must fit into a vector."""


@inline()
def centroid(weight, p, axis, support):
    """Centroid of a particle's weights along an axis, in cells from its first node."""
    mean = 0.0
    for a in range(support):
        mean += a * weight[p, axis, a]
    return mean


@inline()
def add(nodes, at, weight, X, slope, Y):
    """node ← node + weight X + slope Y, lane by lane."""
    store(nodes, at, plus_product(plus(load(nodes, at), weight, X), slope, Y))


# The pickers name lanes of two vectors: 0 to 7 of the first, 8 to 15 of the second. Of a row of the stress,
# xx, yy, zz, yz, xz, xy, 0, 0, as the second, lane 14 is zero.
_BESIDE = picker(8, 0, 1, 2, 3, 4, 5, 6)
"""1 and a velocity, to be multiplied by the mass of a particle."""
_SLOPE_2D, _SLOPE_3D = picker(0, 0, 0, 8, 8, 8, 8, 8), picker(0, 0, 0, 0, 8, 8, 8, 8)
"""The lever in the lanes of the momentum, the gradient in those of the force."""
_COLUMN_0_2D, _COLUMN_1_2D = picker(14, 0, 2, 8, 13, 14, 14, 14), picker(14, 1, 3, 13, 9, 14, 14, 14)
"""Columns of the affine part c00, c01, c10, c11 and of the stress, in two dimensions."""
_COLUMN_0, _COLUMN_1 = picker(14, 0, 3, 6, 8, 13, 12, 14), picker(14, 1, 4, 7, 13, 9, 11, 14)
_COLUMN_2 = picker(14, 1, 4, 7, 12, 11, 10, 14)
"""The same in three dimensions; the last is of an affine part that is read from c01 on."""


@cache
def scatter(dim: int, support: int):
    """The kernel that maps mass, momentum and force to the nodes, for a shape function of that support.

    ``scatter(nodes, strides, lower, tasks, base, weight, gradient, hoop, mass, velocity, affine, volume,
    stress, pressure, acceleration, cell_size, momentum, forces)`` adds mass and momentum (if ``momentum``)
    and the force (if ``forces``) of all particles. ``acceleration`` has a row for each particle, or one for
    all.

    m v = Σ m N (v + C (x_node - x̄)), with the affine part C, 1/s, where ``affine`` has columns, about the
    centroid x̄ = Σ N x_node, so that it adds no momentum.
    f = Σ m a N - Σ V σ·∇N (eq. 4 of Ferreira et al.), with the hoop stress on the radial component where
    ``hoop`` has columns. ``stress`` holds the extra stress; the Cauchy stress is that minus ``pressure``.
    ``tasks[g, colour, t]`` is the first particle of task t of a colour in group g.

    Both sums have one form. With M = (m, m v, m a) and, for each axis d, the column D_d = (0, m C_d, -V σ_d),
    a particle adds to the record of a node

        N0 N1 N2 M + K0 N1 N2 D_0 + N0 K1 N2 D_1 + N0 N1 K2 D_2,

    where the slope K_d along an axis is the lever (x_node - x̄)_d N_d in the lanes of the momentum and
    ∂N_d/∂x_d in those of the force.
    """
    return _scatter_2d(support) if dim == 2 else _scatter_3d(support)


def _scatter_2d(support):
    @inline()
    def slope(weight, gradient, p, axis, a, mean):
        return _SLOPE_2D(spread((a - mean) * weight[p, axis, a]), spread(gradient[p, axis, a]))

    @kernel()
    def scatter_2d(
        nodes, strides, lower, tasks, base, weight, gradient, hoop, mass, velocity, affine, volume, stress,
        pressure, acceleration, cell_size, momentum, forces,
    ):  # fmt: skip
        radial, has_affine, own = hoop.shape[1] > 0, affine.shape[1] > 0, len(acceleration) > 1
        groups, along, low0, low1 = tasks.shape[0], strides[0], lower[0], lower[1]
        of_all = pack(0.0, 0.0, 0.0, acceleration[0, 0], acceleration[0, 1], 0.0, 0.0, 0.0)
        of_hoop = pack(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)
        normal = pack(1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(groups):
                    for p in range(tasks[g, colour, task], tasks[g, colour, task + 1]):
                        first = (base[p, 0] - low0) * along + (base[p, 1] - low1)
                        m, weighs, V = mass[p] * momentum, mass[p] * forces, -volume[p] * forces
                        M = scale(m, _BESIDE(load_first(velocity, 2 * p, 2), spread(1.0)))
                        pull = of_all
                        if own:
                            a0, a1 = acceleration[p, 0], acceleration[p, 1]
                            pull = pack(0.0, 0.0, 0.0, a0, a1, 0.0, 0.0, 0.0)
                        M = plus(M, weighs, pull)
                        sigma = plus(load_first(stress, 6 * p, 6), -pressure[p], normal)
                        C = load_first(affine, 4 * p, 4) if has_affine else zero()
                        m *= cell_size
                        factor = pack(0.0, m, m, V, V, 0.0, 0.0, 0.0)
                        D0, D1 = (
                            multiply(factor, _COLUMN_0_2D(C, sigma)),
                            multiply(factor, _COLUMN_1_2D(C, sigma)),
                        )
                        of_ring = scale(V * lane(sigma, 2), of_hoop)
                        x0, x1 = centroid(weight, p, 0, support), centroid(weight, p, 1, support)
                        k0, k1 = slope(weight, gradient, p, 1, 0, x1), slope(weight, gradient, p, 1, 1, x1)
                        k2 = slope(weight, gradient, p, 1, 2, x1) if support > 2 else k1
                        k3 = slope(weight, gradient, p, 1, 3, x1) if support > 3 else k1
                        w0, w1 = weight[p, 1, 0], weight[p, 1, 1]
                        w2 = weight[p, 1, 2] if support > 2 else 0.0
                        w3 = weight[p, 1, 3] if support > 3 else 0.0
                        for a in range(support):
                            w = weight[p, 0, a]
                            X = plus_product(scale(w, M), slope(weight, gradient, p, 0, a, x0), D0)
                            if radial:
                                X = plus(X, hoop[p, a], of_ring)
                            Y = scale(w, D1)
                            row = (first + a * along) * NODE
                            add(nodes, row, w0, X, k0, Y)
                            add(nodes, row + NODE, w1, X, k1, Y)
                            if support > 2:
                                add(nodes, row + 2 * NODE, w2, X, k2, Y)
                            if support > 3:
                                add(nodes, row + 3 * NODE, w3, X, k3, Y)

    return scatter_2d


def _scatter_3d(support):
    @inline()
    def slope(weight, gradient, p, axis, a, mean):
        return _SLOPE_3D(spread((a - mean) * weight[p, axis, a]), spread(gradient[p, axis, a]))

    @kernel()
    def scatter_3d(
        nodes, strides, lower, tasks, base, weight, gradient, hoop, mass, velocity, affine, volume, stress,
        pressure, acceleration, cell_size, momentum, forces,
    ):  # fmt: skip
        has_affine, own = affine.shape[1] > 0, len(acceleration) > 1
        groups, low0, low1, low2 = tasks.shape[0], lower[0], lower[1], lower[2]
        plane, line = strides[0], strides[1]
        of_all = pack(0.0, 0.0, 0.0, 0.0, acceleration[0, 0], acceleration[0, 1], acceleration[0, 2], 0.0)
        normal = pack(1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(groups):
                    for p in range(tasks[g, colour, task], tasks[g, colour, task + 1]):
                        first = (base[p, 0] - low0) * plane + (base[p, 1] - low1) * line + (base[p, 2] - low2)
                        m, weighs, V = mass[p] * momentum, mass[p] * forces, -volume[p] * forces
                        M = scale(m, _BESIDE(load_first(velocity, 3 * p, 3), spread(1.0)))
                        pull = of_all
                        if own:
                            a0, a1, a2 = acceleration[p, 0], acceleration[p, 1], acceleration[p, 2]
                            pull = pack(0.0, 0.0, 0.0, 0.0, a0, a1, a2, 0.0)
                        M = plus(M, weighs, pull)
                        sigma = plus(load_first(stress, 6 * p, 6), -pressure[p], normal)
                        C = C_from_1 = zero()
                        if has_affine:
                            C, C_from_1 = load(affine, 9 * p), load(affine, 9 * p + 1)
                        m *= cell_size
                        factor = pack(0.0, m, m, m, V, V, V, 0.0)
                        D0 = multiply(factor, _COLUMN_0(C, sigma))
                        D1 = multiply(factor, _COLUMN_1(C, sigma))
                        D2 = multiply(factor, _COLUMN_2(C_from_1, sigma))
                        x0, x1 = centroid(weight, p, 0, support), centroid(weight, p, 1, support)
                        x2 = centroid(weight, p, 2, support)
                        k0, k1 = slope(weight, gradient, p, 2, 0, x2), slope(weight, gradient, p, 2, 1, x2)
                        k2 = slope(weight, gradient, p, 2, 2, x2) if support > 2 else k1
                        k3 = slope(weight, gradient, p, 2, 3, x2) if support > 3 else k1
                        w0, w1 = weight[p, 2, 0], weight[p, 2, 1]
                        w2 = weight[p, 2, 2] if support > 2 else 0.0
                        w3 = weight[p, 2, 3] if support > 3 else 0.0
                        for a in range(support):
                            w = weight[p, 0, a]
                            MD = plus_product(scale(w, M), slope(weight, gradient, p, 0, a, x0), D0)
                            wD1, wD2 = scale(w, D1), scale(w, D2)
                            for b in range(support):
                                w = weight[p, 1, b]
                                X = plus_product(scale(w, MD), slope(weight, gradient, p, 1, b, x1), wD1)
                                Y = scale(w, wD2)
                                row = (first + a * plane + b * line) * NODE
                                add(nodes, row, w0, X, k0, Y)
                                add(nodes, row + NODE, w1, X, k1, Y)
                                if support > 2:
                                    add(nodes, row + 2 * NODE, w2, X, k2, Y)
                                if support > 3:
                                    add(nodes, row + 3 * NODE, w3, X, k3, Y)

    return scatter_3d


@cache
def scatter_pairs(dim: int, support: int):
    """The kernel that adds Σ measure N and Σ measure N value of a particle field to ``pairs (nodes, 2)``.

    A row of pairs is one vector. Its last lanes are zero and are added to the nodes behind those of the
    particle: the window has two more nodes along its last axis for them, and blocks are wide enough.
    """

    @kernel()
    def scatter_pairs(pairs, strides, lower, tasks, base, weight, measure, values):
        groups, last = tasks.shape[0], dim - 1
        plane, line, low0, low1, low2 = strides[0], strides[1], lower[0], lower[1], lower[last]
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(groups):
                    for p in range(tasks[g, colour, task], tasks[g, colour, task + 1]):
                        first = (base[p, 0] - low0) * plane + (base[p, last] - low2)
                        m, f = measure[p], measure[p] * values[p]
                        w0, w1 = weight[p, last, 0], weight[p, last, 1]
                        w2 = weight[p, last, 2] if support > 2 else 0.0
                        w3 = weight[p, last, 3] if support > 3 else 0.0
                        row = pack(m * w0, f * w0, m * w1, f * w1, m * w2, f * w2, m * w3, f * w3)
                        if dim == 2:
                            for a in range(support):
                                at = PAIR * (first + a * plane)
                                store(pairs, at, plus(load(pairs, at), weight[p, 0, a], row))
                        else:
                            first += (base[p, 1] - low1) * line
                            w0, w1 = weight[p, 1, 0], weight[p, 1, 1]
                            w2 = weight[p, 1, 2] if support > 2 else 0.0
                            w3 = weight[p, 1, 3] if support > 3 else 0.0
                            for a in range(support):
                                of_plane = scale(weight[p, 0, a], row)
                                at = PAIR * (first + a * plane)
                                store(pairs, at, plus(load(pairs, at), w0, of_plane))
                                at += PAIR * line
                                store(pairs, at, plus(load(pairs, at), w1, of_plane))
                                if support > 2:
                                    at += PAIR * line
                                    store(pairs, at, plus(load(pairs, at), w2, of_plane))
                                if support > 3:
                                    at += PAIR * line
                                    store(pairs, at, plus(load(pairs, at), w3, of_plane))

    return scatter_pairs


@cache
def scatter_scalar(dim: int, support: int):
    """The kernel that adds Σ N amount of the particles to ``sums (nodes,)``.

    A row is four doubles. As in ``scatter_pairs``, those behind the particle's nodes add nothing.
    """

    @inline()
    def add_row(sums, at, weight, row):
        store_half(sums, at, plus(load_twice(sums, at), weight, row))

    @kernel()
    def scatter_scalar(sums, strides, lower, tasks, base, weight, amount):
        groups, last = tasks.shape[0], dim - 1
        plane, line, low0, low1, low2 = strides[0], strides[1], lower[0], lower[1], lower[last]
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(groups):
                    for p in range(tasks[g, colour, task], tasks[g, colour, task + 1]):
                        first = (base[p, 0] - low0) * plane + (base[p, last] - low2)
                        w2 = weight[p, last, 2] if support > 2 else 0.0
                        w3 = weight[p, last, 3] if support > 3 else 0.0
                        row = pack(weight[p, last, 0], weight[p, last, 1], w2, w3, 0.0, 0.0, 0.0, 0.0)
                        row = scale(amount[p], row)
                        if dim == 2:
                            for a in range(support):
                                add_row(sums, first + a * plane, weight[p, 0, a], row)
                        else:
                            first += (base[p, 1] - low1) * line
                            for a in range(support):
                                of_plane = scale(weight[p, 0, a], row)
                                for b in range(support):
                                    add_row(sums, first + a * plane + b * line, weight[p, 1, b], of_plane)

    return scatter_scalar
