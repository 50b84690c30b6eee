"""Particles to nodes (P2G).

Particles are kept in blocks of cells. Blocks of one colour touch no common node, so that each colour is
scattered in parallel without a race, in an order that does not depend on the number of threads. A node is a
record of ``NODE`` doubles: mass, momentum (dim), force (dim), and at ``CONTACT`` what it has to do with
walls. A particle adds one vector to each record, which is built up axis by axis: what does not depend on
the innermost axis is multiplied out before it.
"""

from __future__ import annotations

from functools import cache

from numba import prange

from .compile import inline, kernel
from .vectors import LANES, load, pack, plus, scale, store, zero

NODE = LANES
"""Doubles in a node's record: one cache line, one vector."""
CONTACT = NODE - 1
"""Entry of a record that holds a whole number, a sum of bits: of an axis a node lies on one face at most."""
PUSHED, TOUCHED = 1, 8
"""The bits of axis 0; those of axis a are ``PUSHED << a`` and ``TOUCHED << a``: whether the wall pushed the
node when the momentum equation was solved last, and whether material has reached it there in this step."""
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


@cache
def scatter(dim: int, support: int):
    """The kernel that maps mass, momentum and force to the nodes, for a shape function of that support.

    ``scatter(nodes, strides, lower, tasks, base, weight, gradient, hoop, mass, velocity, affine, volume,
    stress, pressure, acceleration, cell_size, momentum, forces)`` adds mass and momentum (if ``momentum``)
    and the force (if ``forces``) of all particles. ``acceleration`` has a row for each, or one for all.

    m v = Σ m N (v + C (x_node - x̄)), with the affine part C, 1/s, where ``affine`` has columns, about the
    centroid x̄ = Σ N x_node, so that it adds no momentum.
    f = Σ m a N - Σ V σ·∇N (eq. 4 of Ferreira et al.), with the hoop stress on the radial component where
    ``hoop`` has columns. ``stress`` holds the extra stress; the Cauchy stress is that minus ``pressure``.
    ``tasks[g, colour, t]`` is the first particle of task t of a colour in group g.
    """
    return _scatter_2d(support) if dim == 2 else _scatter_3d(support)


def _scatter_2d(support):
    @kernel()
    def scatter_2d(
        nodes, strides, lower, tasks, base, weight, gradient, hoop, mass, velocity, affine, volume, stress,
        pressure, acceleration, cell_size, momentum, forces,
    ):  # fmt: skip
        radial = hoop.shape[1] > 0
        has_affine = momentum and affine.shape[1] > 0
        own = len(acceleration) > 1
        groups = tasks.shape[0]
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(groups):
                    for p in range(tasks[g, colour, task], tasks[g, colour, task + 1]):
                        first = (base[p, 0] - lower[0]) * strides[0] + (base[p, 1] - lower[1])
                        m, V = mass[p] * momentum, -volume[p] * forces
                        weighs, k = mass[p] * forces, p if own else 0
                        s00, s11 = V * (stress[p, 0] - pressure[p]), V * (stress[p, 1] - pressure[p])
                        s22, s01 = V * (stress[p, 2] - pressure[p]), V * stress[p, 5]
                        # What the particle gives, by the factor it comes with: N, ∂N/∂x, ∂N/∂y, N/r.
                        M = pack(
                            m, m * velocity[p, 0], m * velocity[p, 1],
                            weighs * acceleration[k, 0], weighs * acceleration[k, 1], 0.0, 0.0, 0.0,
                        )  # fmt: skip
                        S0 = pack(0.0, 0.0, 0.0, s00, s01, 0.0, 0.0, 0.0)
                        S1 = pack(0.0, 0.0, 0.0, s01, s11, 0.0, 0.0, 0.0)
                        Sh = pack(0.0, 0.0, 0.0, s22, 0.0, 0.0, 0.0, 0.0)
                        C0 = C1 = zero()
                        if has_affine:  # M becomes what the affine field is at node (0, 0) of the particle
                            h = m * cell_size
                            C0 = pack(0.0, h * affine[p, 0, 0], h * affine[p, 1, 0], 0.0, 0.0, 0.0, 0.0, 0.0)
                            C1 = pack(0.0, h * affine[p, 0, 1], h * affine[p, 1, 1], 0.0, 0.0, 0.0, 0.0, 0.0)
                            M = plus(M, -centroid(weight, p, 0, support), C0)
                            M = plus(M, -centroid(weight, p, 1, support), C1)
                        for a in range(support):
                            w0, g0 = weight[p, 0, a], gradient[p, 0, a]
                            X = plus(scale(w0, plus(M, float(a), C0)), g0, S0)
                            if radial:
                                X = plus(X, hoop[p, a], Sh)
                            Y, Z = scale(w0, S1), scale(w0, C1)
                            row = (first + a * strides[0]) * NODE
                            for b in range(support):
                                w1 = weight[p, 1, b]
                                node = load(nodes, row + b * NODE)
                                node = plus(node, w1, X)
                                node = plus(node, gradient[p, 1, b], Y)
                                if has_affine:
                                    node = plus(node, b * w1, Z)
                                store(nodes, row + b * NODE, node)

    return scatter_2d


def _scatter_3d(support):
    @kernel()
    def scatter_3d(
        nodes, strides, lower, tasks, base, weight, gradient, hoop, mass, velocity, affine, volume, stress,
        pressure, acceleration, cell_size, momentum, forces,
    ):  # fmt: skip
        has_affine = momentum and affine.shape[1] > 0
        own = len(acceleration) > 1
        groups = tasks.shape[0]
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(groups):
                    for p in range(tasks[g, colour, task], tasks[g, colour, task + 1]):
                        first = (
                            (base[p, 0] - lower[0]) * strides[0]
                            + (base[p, 1] - lower[1]) * strides[1]
                            + (base[p, 2] - lower[2])
                        )
                        m, V = mass[p] * momentum, -volume[p] * forces
                        weighs, k = mass[p] * forces, p if own else 0
                        s00, s11 = V * (stress[p, 0] - pressure[p]), V * (stress[p, 1] - pressure[p])
                        s22 = V * (stress[p, 2] - pressure[p])
                        s12, s02, s01 = V * stress[p, 3], V * stress[p, 4], V * stress[p, 5]
                        # What the particle gives, by the factor it comes with: N, ∂N/∂x, ∂N/∂y, ∂N/∂z.
                        M = pack(
                            m, m * velocity[p, 0], m * velocity[p, 1], m * velocity[p, 2],
                            weighs * acceleration[k, 0], weighs * acceleration[k, 1],
                            weighs * acceleration[k, 2], 0.0,
                        )  # fmt: skip
                        S0 = pack(0.0, 0.0, 0.0, 0.0, s00, s01, s02, 0.0)
                        S1 = pack(0.0, 0.0, 0.0, 0.0, s01, s11, s12, 0.0)
                        S2 = pack(0.0, 0.0, 0.0, 0.0, s02, s12, s22, 0.0)
                        C0 = C1 = C2 = zero()
                        if has_affine:  # M becomes what the affine field is at the particle's first node
                            h = m * cell_size
                            c00, c10, c20 = h * affine[p, 0, 0], h * affine[p, 1, 0], h * affine[p, 2, 0]
                            c01, c11, c21 = h * affine[p, 0, 1], h * affine[p, 1, 1], h * affine[p, 2, 1]
                            c02, c12, c22 = h * affine[p, 0, 2], h * affine[p, 1, 2], h * affine[p, 2, 2]
                            C0 = pack(0.0, c00, c10, c20, 0.0, 0.0, 0.0, 0.0)
                            C1 = pack(0.0, c01, c11, c21, 0.0, 0.0, 0.0, 0.0)
                            C2 = pack(0.0, c02, c12, c22, 0.0, 0.0, 0.0, 0.0)
                            M = plus(M, -centroid(weight, p, 0, support), C0)
                            M = plus(M, -centroid(weight, p, 1, support), C1)
                            M = plus(M, -centroid(weight, p, 2, support), C2)
                        for a in range(support):
                            w0 = weight[p, 0, a]
                            MS = plus(scale(w0, plus(M, float(a), C0)), gradient[p, 0, a], S0)
                            wS1, wS2, wC1, wC2 = scale(w0, S1), scale(w0, S2), scale(w0, C1), scale(w0, C2)
                            for b in range(support):
                                w1 = weight[p, 1, b]
                                X = plus(scale(w1, plus(MS, float(b), wC1)), gradient[p, 1, b], wS1)
                                Y, Z = scale(w1, wS2), scale(w1, wC2)
                                row = (first + a * strides[0] + b * strides[1]) * NODE
                                for c in range(support):
                                    w2 = weight[p, 2, c]
                                    node = load(nodes, row + c * NODE)
                                    node = plus(node, w2, X)
                                    node = plus(node, gradient[p, 2, c], Y)
                                    if has_affine:
                                        node = plus(node, c * w2, Z)
                                    store(nodes, row + c * NODE, node)

    return scatter_3d


@cache
def scatter_pairs(dim: int, support: int):
    """The kernel that adds Σ measure N and Σ measure N value of a particle field to ``pairs (nodes, 2)``.

    A row of pairs is one vector, whose last lanes add nothing to the nodes behind the particle's; the window
    has two nodes more along its last axis for them, and blocks are wide enough.
    """

    @kernel()
    def scatter_pairs(pairs, strides, lower, tasks, base, weight, measure, values):
        groups, last = tasks.shape[0], dim - 1
        planes = support if dim == 3 else 1
        for colour in range(tasks.shape[1]):
            for task in prange(tasks.shape[2] - 1):
                for g in range(groups):
                    for p in range(tasks[g, colour, task], tasks[g, colour, task + 1]):
                        first = 0
                        for d in range(dim):
                            first += (base[p, d] - lower[d]) * strides[d]
                        m, f = measure[p], measure[p] * values[p]
                        w0, w1 = weight[p, last, 0], weight[p, last, 1]
                        w2 = weight[p, last, 2] if support > 2 else 0.0
                        w3 = weight[p, last, 3] if support > 3 else 0.0
                        row = pack(m * w0, f * w0, m * w1, f * w1, m * w2, f * w2, m * w3, f * w3)
                        for a in range(support):
                            for b in range(planes):
                                w = weight[p, 0, a] * (weight[p, 1, b] if dim == 3 else 1.0)
                                at = PAIR * (first + a * strides[0] + b * strides[1])
                                store(pairs, at, plus(load(pairs, at), w, row))

    return scatter_pairs
