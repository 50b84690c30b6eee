"""Nodes to particles (G2P). A solved node's record holds mass, velocity (dim), change of velocity (dim)."""

from __future__ import annotations

from numba import prange

from .compile import CHUNK, chunk_count, kernel

LEAST_MOMENT = 0.125
"""Least second moment of the weights of cpGIMP with two particles an axis, in cells²."""


@kernel()
def advance_2d(nodes, strides, lower, base, weight, hoop, dt, flip, position, velocity):
    """x ← x + dt ṽ; v ← flip (v + Δṽ) + (1 - flip) ṽ.

    In an axisymmetric scene the radius moves as r ← r (1 + dt D_θθ): the radially weighted average of
    v_r belongs to the centroid of the particle's ring, not to its middle, and near the axis the two differ;
    the hoop rate is exact for the middle, and the axis can never be crossed.
    """
    n, support = len(position), weight.shape[2]
    radial = hoop.shape[1] > 0
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            first = (base[p, 0] - lower[0]) * strides[0] + (base[p, 1] - lower[1]) * strides[1]
            v0 = v1 = dv0 = dv1 = hoop_rate = 0.0
            for a in range(support):
                w0 = weight[p, 0, a]
                row = first + a * strides[0]
                for b in range(support):
                    w = w0 * weight[p, 1, b]
                    i = row + b
                    v0 += w * nodes[i, 1]
                    v1 += w * nodes[i, 2]
                    dv0 += w * nodes[i, 3]
                    dv1 += w * nodes[i, 4]
                    if radial:
                        hoop_rate += hoop[p, a] * weight[p, 1, b] * nodes[i, 1]
            position[p, 0] += dt * (position[p, 0] * hoop_rate if radial else v0)
            position[p, 1] += dt * v1
            velocity[p, 0] = flip * (velocity[p, 0] + dv0) + (1 - flip) * v0
            velocity[p, 1] = flip * (velocity[p, 1] + dv1) + (1 - flip) * v1


@kernel()
def advance_3d(nodes, strides, lower, base, weight, hoop, dt, flip, position, velocity):
    """As ``advance_2d``, in three dimensions; ``hoop`` is not used."""
    n, support = len(position), weight.shape[2]
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            first = (
                (base[p, 0] - lower[0]) * strides[0]
                + (base[p, 1] - lower[1]) * strides[1]
                + (base[p, 2] - lower[2])
            )
            v0 = v1 = v2 = dv0 = dv1 = dv2 = 0.0
            for a in range(support):
                for b in range(support):
                    w01 = weight[p, 0, a] * weight[p, 1, b]
                    row = first + a * strides[0] + b * strides[1]
                    for c in range(support):
                        w = w01 * weight[p, 2, c]
                        i = row + c
                        v0 += w * nodes[i, 1]
                        v1 += w * nodes[i, 2]
                        v2 += w * nodes[i, 3]
                        dv0 += w * nodes[i, 4]
                        dv1 += w * nodes[i, 5]
                        dv2 += w * nodes[i, 6]
            position[p, 0] += dt * v0
            position[p, 1] += dt * v1
            position[p, 2] += dt * v2
            velocity[p, 0] = flip * (velocity[p, 0] + dv0) + (1 - flip) * v0
            velocity[p, 1] = flip * (velocity[p, 1] + dv1) + (1 - flip) * v1
            velocity[p, 2] = flip * (velocity[p, 2] + dv2) + (1 - flip) * v2


@kernel()
def gradient_2d(nodes, strides, lower, base, weight, gradient, hoop, L):
    """L_ij = Σ v_i ∂N/∂x_j, and L_θθ = Σ v_r N/r where ``hoop`` has columns; the rest stays as it is."""
    n, support = len(L), weight.shape[2]
    radial = hoop.shape[1] > 0
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            first = (base[p, 0] - lower[0]) * strides[0] + (base[p, 1] - lower[1]) * strides[1]
            l00 = l01 = l10 = l11 = l22 = 0.0
            for a in range(support):
                w0, g0 = weight[p, 0, a], gradient[p, 0, a]
                row = first + a * strides[0]
                # Contract along the second axis first: the sums over b serve every term of the row.
                v0 = v1 = u0 = u1 = 0.0
                for b in range(support):
                    i = row + b
                    v0 += weight[p, 1, b] * nodes[i, 1]
                    v1 += weight[p, 1, b] * nodes[i, 2]
                    u0 += gradient[p, 1, b] * nodes[i, 1]
                    u1 += gradient[p, 1, b] * nodes[i, 2]
                l00 += g0 * v0
                l10 += g0 * v1
                l01 += w0 * u0
                l11 += w0 * u1
                if radial:
                    l22 += hoop[p, a] * v0
            L[p, 0, 0], L[p, 0, 1], L[p, 1, 0], L[p, 1, 1] = l00, l01, l10, l11
            if radial:
                L[p, 2, 2] = l22


@kernel()
def gradient_3d(nodes, strides, lower, base, weight, gradient, hoop, L):
    """As ``gradient_2d``, in three dimensions; ``hoop`` is not used."""
    n, support = len(L), weight.shape[2]
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            first = (
                (base[p, 0] - lower[0]) * strides[0]
                + (base[p, 1] - lower[1]) * strides[1]
                + (base[p, 2] - lower[2])
            )
            l00 = l01 = l02 = l10 = l11 = l12 = l20 = l21 = l22 = 0.0
            for a in range(support):
                w0, g0 = weight[p, 0, a], gradient[p, 0, a]
                # Contract axis by axis, innermost first: v, ∂v/∂y, ∂v/∂z along this plane of nodes.
                v0 = v1 = v2 = y0 = y1 = y2 = z0 = z1 = z2 = 0.0
                for b in range(support):
                    w1, g1 = weight[p, 1, b], gradient[p, 1, b]
                    row = first + a * strides[0] + b * strides[1]
                    r0 = r1 = r2 = s0 = s1 = s2 = 0.0
                    for c in range(support):
                        i = row + c
                        w2, g2 = weight[p, 2, c], gradient[p, 2, c]
                        r0 += w2 * nodes[i, 1]
                        r1 += w2 * nodes[i, 2]
                        r2 += w2 * nodes[i, 3]
                        s0 += g2 * nodes[i, 1]
                        s1 += g2 * nodes[i, 2]
                        s2 += g2 * nodes[i, 3]
                    v0 += w1 * r0
                    v1 += w1 * r1
                    v2 += w1 * r2
                    y0 += g1 * r0
                    y1 += g1 * r1
                    y2 += g1 * r2
                    z0 += w1 * s0
                    z1 += w1 * s1
                    z2 += w1 * s2
                l00 += g0 * v0
                l10 += g0 * v1
                l20 += g0 * v2
                l01 += w0 * y0
                l11 += w0 * y1
                l21 += w0 * y2
                l02 += w0 * z0
                l12 += w0 * z1
                l22 += w0 * z2
            L[p, 0, 0], L[p, 0, 1], L[p, 0, 2] = l00, l01, l02
            L[p, 1, 0], L[p, 1, 1], L[p, 1, 2] = l10, l11, l12
            L[p, 2, 0], L[p, 2, 1], L[p, 2, 2] = l20, l21, l22


@kernel()
def affine_slopes(weight, cell_size, slope):
    """1-D tables that give the affine part of a nodal field: N (x_node - x̄) / D, D = Σ N (x_node - x̄)², 1/m.

    D, which nearly vanishes where a small box is at a node, counts as ``LEAST_MOMENT`` at the least: a
    particle that barely reaches beyond one node knows no slope, and would be stiffer than the sound with one.
    """
    n, dim, support = weight.shape
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            for d in range(dim):
                mean = moment = 0.0
                for a in range(support):
                    mean += a * weight[p, d, a]
                for a in range(support):
                    moment += weight[p, d, a] * (a - mean) ** 2
                scale = 1.0 / (max(moment, LEAST_MOMENT) * cell_size)
                for a in range(support):
                    slope[p, d, a] = weight[p, d, a] * (a - mean) * scale


@kernel()
def gather_scalar(field, strides, lower, base, weight, out):
    """Σ N value of a nodal field at the particles, in any dimension."""
    n, dim, support = weight.shape
    last = support if dim == 3 else 1
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            first = 0
            for d in range(dim):
                first += (base[p, d] - lower[d]) * strides[d]
            value = 0.0
            for a in range(support):
                for b in range(support):
                    w01 = weight[p, 0, a] * weight[p, 1, b]
                    row = first + a * strides[0] + b * strides[1]
                    for c in range(last):
                        value += (w01 * weight[p, 2, c] if dim == 3 else w01) * field[row + c]
            out[p] = value
