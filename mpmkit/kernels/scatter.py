"""Particles to nodes (P2G).

Particles are kept in slabs of cells along the first axis. Slabs of one colour touch no common node, so
that each colour is scattered in parallel without a race, in an order that does not depend on the number of
threads. A node is a record of ``NODE`` doubles: mass, momentum (dim), force (dim), and at ``CONTACT`` the sum
of 2^axis over the axes along which it touches a Coulomb wall.
"""

from __future__ import annotations

from numba import prange

from .compile import inline, kernel

NODE = 8
"""Doubles in a node's record: one cache line."""
CONTACT = NODE - 1


@inline()
def _mean(weight, p, axis):
    """Centroid of a particle's weights along an axis, in cells from its first node."""
    mean = 0.0
    for a in range(1, weight.shape[2]):
        mean += a * weight[p, axis, a]
    return mean


@kernel()
def scatter_2d(
    nodes, strides, lower, slabs, base, weight, gradient, hoop, mass, velocity, affine, volume, stress,
    pressure, gravity, cell_size, momentum, forces,
):  # fmt: skip
    """Add mass and momentum (if ``momentum``) and the force (if ``forces``) of all particles to the nodes.

    m v = Σ m N (v + C (x_node - x̄)), with the affine part C, 1/s, where ``affine`` has columns, about the
    centroid x̄ = Σ N x_node, so that it adds no momentum.
    f = Σ m g N - Σ V σ·∇N (eq. 4 of Ferreira et al.), with the hoop stress on the radial component where
    ``hoop`` has columns. ``stress`` holds the extra stress; the Cauchy stress is that minus ``pressure``.
    ``slabs[g, s]`` is the first particle of slab s in group g.
    """
    support = weight.shape[2]
    radial = hoop.shape[1] > 0
    has_affine = momentum and affine.shape[1] > 0
    count = slabs.shape[1] - 1
    for colour in range(2):
        for k in prange((count - colour + 1) // 2):
            s = 2 * k + colour
            for g in range(slabs.shape[0]):
                for p in range(slabs[g, s], slabs[g, s + 1]):
                    m = mass[p]
                    v0, v1 = velocity[p, 0], velocity[p, 1]
                    V = volume[p]
                    s00, s11 = V * (stress[p, 0] - pressure[p]), V * (stress[p, 1] - pressure[p])
                    s22, s01 = V * (stress[p, 2] - pressure[p]), V * stress[p, 5]
                    first = (base[p, 0] - lower[0]) * strides[0] + (base[p, 1] - lower[1]) * strides[1]
                    c00 = c01 = c10 = c11 = 0.0
                    if has_affine:  # v becomes what the affine field is at node (0, 0) of the particle
                        c00, c01 = affine[p, 0, 0] * cell_size, affine[p, 0, 1] * cell_size
                        c10, c11 = affine[p, 1, 0] * cell_size, affine[p, 1, 1] * cell_size
                        mean0, mean1 = _mean(weight, p, 0), _mean(weight, p, 1)
                        v0 -= c00 * mean0 + c01 * mean1
                        v1 -= c10 * mean0 + c11 * mean1
                    for a in range(support):
                        w0, g0 = weight[p, 0, a], gradient[p, 0, a]
                        h0 = hoop[p, a] if radial else 0.0
                        row = first + a * strides[0]
                        for b in range(support):
                            w1 = weight[p, 1, b]
                            wm = m * w0 * w1
                            i = row + b
                            if momentum:
                                nodes[i, 0] += wm
                                nodes[i, 1] += wm * (v0 + c00 * a + c01 * b)
                                nodes[i, 2] += wm * (v1 + c10 * a + c11 * b)
                            if forces:
                                d0, d1 = g0 * w1, w0 * gradient[p, 1, b]
                                nodes[i, 3] += wm * gravity[0] - s00 * d0 - s01 * d1 - s22 * h0 * w1
                                nodes[i, 4] += wm * gravity[1] - s01 * d0 - s11 * d1


@kernel()
def scatter_3d(
    nodes, strides, lower, slabs, base, weight, gradient, hoop, mass, velocity, affine, volume, stress,
    pressure, gravity, cell_size, momentum, forces,
):  # fmt: skip
    """As ``scatter_2d``, in three dimensions; ``hoop`` is not used."""
    support = weight.shape[2]
    has_affine = momentum and affine.shape[1] > 0
    count = slabs.shape[1] - 1
    for colour in range(2):
        for k in prange((count - colour + 1) // 2):
            s = 2 * k + colour
            for g in range(slabs.shape[0]):
                for p in range(slabs[g, s], slabs[g, s + 1]):
                    m = mass[p]
                    v0, v1, v2 = velocity[p, 0], velocity[p, 1], velocity[p, 2]
                    V = volume[p]
                    s00, s11 = V * (stress[p, 0] - pressure[p]), V * (stress[p, 1] - pressure[p])
                    s22 = V * (stress[p, 2] - pressure[p])
                    s12, s02, s01 = V * stress[p, 3], V * stress[p, 4], V * stress[p, 5]
                    first = (
                        (base[p, 0] - lower[0]) * strides[0]
                        + (base[p, 1] - lower[1]) * strides[1]
                        + (base[p, 2] - lower[2])
                    )
                    c00 = c01 = c02 = c10 = c11 = c12 = c20 = c21 = c22 = 0.0
                    if has_affine:
                        c00, c10, c20 = affine[p, 0, 0], affine[p, 1, 0], affine[p, 2, 0]
                        c01, c11, c21 = affine[p, 0, 1], affine[p, 1, 1], affine[p, 2, 1]
                        c02, c12, c22 = affine[p, 0, 2], affine[p, 1, 2], affine[p, 2, 2]
                        c00, c01, c02 = c00 * cell_size, c01 * cell_size, c02 * cell_size
                        c10, c11, c12 = c10 * cell_size, c11 * cell_size, c12 * cell_size
                        c20, c21, c22 = c20 * cell_size, c21 * cell_size, c22 * cell_size
                        mean0, mean1, mean2 = _mean(weight, p, 0), _mean(weight, p, 1), _mean(weight, p, 2)
                        v0 -= c00 * mean0 + c01 * mean1 + c02 * mean2
                        v1 -= c10 * mean0 + c11 * mean1 + c12 * mean2
                        v2 -= c20 * mean0 + c21 * mean1 + c22 * mean2
                    for a in range(support):
                        w0, g0 = weight[p, 0, a], gradient[p, 0, a]
                        for b in range(support):
                            u0, u1, u2 = (
                                v0 + c00 * a + c01 * b,
                                v1 + c10 * a + c11 * b,
                                v2 + c20 * a + c21 * b,
                            )
                            w01 = w0 * weight[p, 1, b]
                            g0w1 = g0 * weight[p, 1, b]
                            w0g1 = w0 * gradient[p, 1, b]
                            row = first + a * strides[0] + b * strides[1]
                            for c in range(support):
                                w2 = weight[p, 2, c]
                                wm = m * w01 * w2
                                i = row + c
                                if momentum:
                                    nodes[i, 0] += wm
                                    nodes[i, 1] += wm * (u0 + c02 * c)
                                    nodes[i, 2] += wm * (u1 + c12 * c)
                                    nodes[i, 3] += wm * (u2 + c22 * c)
                                if forces:
                                    d0, d1, d2 = g0w1 * w2, w0g1 * w2, w01 * gradient[p, 2, c]
                                    nodes[i, 4] += wm * gravity[0] - s00 * d0 - s01 * d1 - s02 * d2
                                    nodes[i, 5] += wm * gravity[1] - s01 * d0 - s11 * d1 - s12 * d2
                                    nodes[i, 6] += wm * gravity[2] - s02 * d0 - s12 * d1 - s22 * d2


@kernel()
def scatter_scalar(field, strides, lower, slabs, base, weight, measure, values):
    """Σ measure N and Σ measure N value of a particle field into ``field (nodes, 2)``, in any dimension."""
    dim, support = weight.shape[1], weight.shape[2]
    last = support if dim == 3 else 1
    count = slabs.shape[1] - 1
    for colour in range(2):
        for k in prange((count - colour + 1) // 2):
            s = 2 * k + colour
            for g in range(slabs.shape[0]):
                for p in range(slabs[g, s], slabs[g, s + 1]):
                    first = 0
                    for d in range(dim):
                        first += (base[p, d] - lower[d]) * strides[d]
                    for a in range(support):
                        for b in range(support):
                            w01 = measure[p] * weight[p, 0, a] * weight[p, 1, b]
                            row = first + a * strides[0] + b * strides[1]
                            for c in range(last):
                                w = w01 * weight[p, 2, c] if dim == 3 else w01
                                field[row + c, 0] += w
                                field[row + c, 1] += w * values[p]
