"""Nodes to particles (G2P). A solved node's record holds mass, velocity (dim), change of velocity (dim).

Records are summed whole, as vectors, axis by axis: the sums along the innermost axis serve every term of
their row, and those over a plane every term of the plane.
"""

from __future__ import annotations

from functools import cache

from numba import prange

from .compile import CHUNK, chunk_count, inline, kernel
from .scatter import NODE, centroid
from .vectors import lane, load, plus, scale, zero

LEAST_MOMENT = 0.125
"""Least second moment of the weights of cpGIMP with two particles an axis, in cells²."""


@inline()
def _inverse_moment(weight, p, axis, support, mean):
    """1 / Σ N (x_node - x̄)² along an axis, in 1/cells².

    The moment, which nearly vanishes where a small box is at a node, counts as ``LEAST_MOMENT`` at the least:
    a particle that barely reaches beyond one node knows no slope, and would be stiffer than sound with one.
    """
    moment = 0.0
    for a in range(support):
        moment += weight[p, axis, a] * (a - mean) ** 2
    return 1.0 / max(moment, LEAST_MOMENT)


@cache
def gather(dim: int, support: int):
    """The kernel that takes velocities and their slopes to the particles.

    ``gather(nodes, strides, lower, base, weight, gradient, hoop, cell_size, dt, flip, position, velocity, L,
    rate, affine, move, strain, has_affine)`` does, in one pass over the nodes of each particle,

    - if ``move``: x ← x + dt ṽ and v ← flip (v + Δṽ) + (1 - flip) ṽ;
    - if ``strain``: L_ij = Σ v_i ∂N/∂x_j, L_θθ = Σ v_r N/r where ``hoop`` has columns, and rate = tr L;
    - if ``has_affine``: C = Σ N v (x_node - x̄)ᵀ D⁻¹, with the diagonal D = Σ N (x_node - x̄)².

    In an axisymmetric scene the radius moves as r ← r (1 + dt D_θθ): the radially weighted average of
    v_r belongs to the centroid of the particle's ring, not to its middle, and near the axis the two differ;
    the hoop rate is exact for the middle, and the axis can never be crossed.
    """
    return _gather_2d(support) if dim == 2 else _gather_3d(support)


def _gather_2d(support):
    @kernel()
    def gather_2d(
        nodes, strides, lower, base, weight, gradient, hoop, cell_size, dt, flip, position, velocity, L, rate,
        affine, move, strain, has_affine,
    ):  # fmt: skip
        n = len(position)
        radial = hoop.shape[1] > 0
        for chunk in prange(chunk_count(n)):
            for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
                first = (base[p, 0] - lower[0]) * strides[0] + (base[p, 1] - lower[1])
                v = x = y = ax = ay = h = zero()
                for a in range(support):
                    w0 = weight[p, 0, a]
                    row = (first + a * strides[0]) * NODE
                    rv = ry = ray = zero()
                    for b in range(support):
                        w1 = weight[p, 1, b]
                        node = load(nodes, row + b * NODE)
                        rv = plus(rv, w1, node)
                        ry = plus(ry, gradient[p, 1, b], node)
                        if has_affine:
                            ray = plus(ray, b * w1, node)
                    v = plus(v, w0, rv)
                    x = plus(x, gradient[p, 0, a], rv)
                    y = plus(y, w0, ry)
                    if radial:
                        h = plus(h, hoop[p, a], rv)
                    if has_affine:
                        ax = plus(ax, a * w0, rv)
                        ay = plus(ay, w0, ray)
                if strain:
                    L[p, 0, 0], L[p, 0, 1] = lane(x, 1), lane(y, 1)
                    L[p, 1, 0], L[p, 1, 1] = lane(x, 2), lane(y, 2)
                    L[p, 2, 2] = lane(h, 1)
                    rate[p] = lane(x, 1) + lane(y, 2) + lane(h, 1)
                if has_affine:
                    m0, m1 = centroid(weight, p, 0, support), centroid(weight, p, 1, support)
                    d0 = _inverse_moment(weight, p, 0, support, m0) / cell_size
                    d1 = _inverse_moment(weight, p, 1, support, m1) / cell_size
                    ax, ay = scale(d0, plus(ax, -m0, v)), scale(d1, plus(ay, -m1, v))
                    affine[p, 0, 0], affine[p, 0, 1] = lane(ax, 1), lane(ay, 1)
                    affine[p, 1, 0], affine[p, 1, 1] = lane(ax, 2), lane(ay, 2)
                if move:
                    v0, v1 = lane(v, 1), lane(v, 2)
                    position[p, 0] += dt * (position[p, 0] * lane(h, 1) if radial else v0)
                    position[p, 1] += dt * v1
                    velocity[p, 0] = flip * (velocity[p, 0] + lane(v, 3)) + (1 - flip) * v0
                    velocity[p, 1] = flip * (velocity[p, 1] + lane(v, 4)) + (1 - flip) * v1

    return gather_2d


def _gather_3d(support):
    @kernel()
    def gather_3d(
        nodes, strides, lower, base, weight, gradient, hoop, cell_size, dt, flip, position, velocity, L, rate,
        affine, move, strain, has_affine,
    ):  # fmt: skip
        n = len(position)
        for chunk in prange(chunk_count(n)):
            for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
                first = (
                    (base[p, 0] - lower[0]) * strides[0]
                    + (base[p, 1] - lower[1]) * strides[1]
                    + (base[p, 2] - lower[2])
                )
                v = x = y = z = ax = ay = az = zero()
                for a in range(support):
                    w0 = weight[p, 0, a]
                    pv = py = pz = pay = paz = zero()
                    for b in range(support):
                        w1 = weight[p, 1, b]
                        row = (first + a * strides[0] + b * strides[1]) * NODE
                        rv = rz = raz = zero()
                        for c in range(support):
                            w2 = weight[p, 2, c]
                            node = load(nodes, row + c * NODE)
                            rv = plus(rv, w2, node)
                            rz = plus(rz, gradient[p, 2, c], node)
                            if has_affine:
                                raz = plus(raz, c * w2, node)
                        pv = plus(pv, w1, rv)
                        py = plus(py, gradient[p, 1, b], rv)
                        pz = plus(pz, w1, rz)
                        if has_affine:
                            pay = plus(pay, b * w1, rv)
                            paz = plus(paz, w1, raz)
                    v = plus(v, w0, pv)
                    x = plus(x, gradient[p, 0, a], pv)
                    y = plus(y, w0, py)
                    z = plus(z, w0, pz)
                    if has_affine:
                        ax = plus(ax, a * w0, pv)
                        ay = plus(ay, w0, pay)
                        az = plus(az, w0, paz)
                if strain:
                    L[p, 0, 0], L[p, 0, 1], L[p, 0, 2] = lane(x, 1), lane(y, 1), lane(z, 1)
                    L[p, 1, 0], L[p, 1, 1], L[p, 1, 2] = lane(x, 2), lane(y, 2), lane(z, 2)
                    L[p, 2, 0], L[p, 2, 1], L[p, 2, 2] = lane(x, 3), lane(y, 3), lane(z, 3)
                    rate[p] = lane(x, 1) + lane(y, 2) + lane(z, 3)
                if has_affine:
                    m0 = centroid(weight, p, 0, support)
                    m1 = centroid(weight, p, 1, support)
                    m2 = centroid(weight, p, 2, support)
                    ax = scale(_inverse_moment(weight, p, 0, support, m0) / cell_size, plus(ax, -m0, v))
                    ay = scale(_inverse_moment(weight, p, 1, support, m1) / cell_size, plus(ay, -m1, v))
                    az = scale(_inverse_moment(weight, p, 2, support, m2) / cell_size, plus(az, -m2, v))
                    affine[p, 0, 0], affine[p, 0, 1], affine[p, 0, 2] = lane(ax, 1), lane(ay, 1), lane(az, 1)
                    affine[p, 1, 0], affine[p, 1, 1], affine[p, 1, 2] = lane(ax, 2), lane(ay, 2), lane(az, 2)
                    affine[p, 2, 0], affine[p, 2, 1], affine[p, 2, 2] = lane(ax, 3), lane(ay, 3), lane(az, 3)
                if move:
                    v0, v1, v2 = lane(v, 1), lane(v, 2), lane(v, 3)
                    position[p, 0] += dt * v0
                    position[p, 1] += dt * v1
                    position[p, 2] += dt * v2
                    velocity[p, 0] = flip * (velocity[p, 0] + lane(v, 4)) + (1 - flip) * v0
                    velocity[p, 1] = flip * (velocity[p, 1] + lane(v, 5)) + (1 - flip) * v1
                    velocity[p, 2] = flip * (velocity[p, 2] + lane(v, 6)) + (1 - flip) * v2

    return gather_3d


@cache
def gather_scalar(dim: int, support: int):
    """The kernel that takes Σ N value of a nodal field to the particles, into ``out (n,)``.

    Rows are read as whole vectors, so that ``field`` must have ``LANES`` more doubles behind it than nodes.
    """

    @kernel()
    def gather_scalar(field, strides, lower, base, weight, out):
        n, last = len(base), dim - 1
        planes = support if dim == 3 else 1
        for chunk in prange(chunk_count(n)):
            for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
                first = 0
                for d in range(dim):
                    first += (base[p, d] - lower[d]) * strides[d]
                total = zero()
                for a in range(support):
                    for b in range(planes):
                        w = weight[p, 0, a] * (weight[p, 1, b] if dim == 3 else 1.0)
                        total = plus(total, w, load(field, first + a * strides[0] + b * strides[1]))
                value = weight[p, last, 0] * lane(total, 0) + weight[p, last, 1] * lane(total, 1)
                if support > 2:
                    value += weight[p, last, 2] * lane(total, 2)
                if support > 3:
                    value += weight[p, last, 3] * lane(total, 3)
                out[p] = value

    return gather_scalar
