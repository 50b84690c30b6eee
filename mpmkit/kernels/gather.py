"""Nodes to particles (G2P). A solved node's record holds mass, velocity (dim), change of velocity (dim).

Whole records are summed as vectors, axis by axis: a sum along the innermost axis is used for every term of
its row, and a sum over a plane for every term of the plane.
"""

from __future__ import annotations

from functools import cache

from numba import prange

from .compile import CHUNK, chunk_count, inline, kernel
from .scatter import NODE, centroid
from .vectors import (
    lane,
    load,
    load_first,
    load_twice,
    picker,
    plus,
    plus_product,
    scale,
    spread,
    store,
    zero,
)

LEAST_MOMENT = 0.125
"""Smallest second moment of the weights of cpGIMP with two particles along an axis, in cells²."""


@inline()
def _inverse_moment(weight, p, axis, support, mean, cell_size):
    """Δx / Σ N (x_node - x̄)² along an axis, in 1/m.

    The moment nearly vanishes if a small box lies at a node. So it counts at least as ``LEAST_MOMENT``: a
    particle that barely reaches beyond one node cannot determine a slope, and with one it would be so stiff
    that the acoustic limit of the time step does not hold.
    """
    moment = 0.0
    for a in range(support):
        moment += weight[p, axis, a] * (a - mean) ** 2
    return 1.0 / (max(moment, LEAST_MOMENT) * cell_size)


# The pickers name lanes of two vectors: 0 to 7 of the first, 8 to 15 of the second. In a sum of slopes, lanes
# 0 to 3 are the terms of the lever, and lanes 4 to 7 those of the gradient, for mass and velocity each.
_SLOPE = picker(0, 0, 0, 0, 8, 8, 8, 8)
_TWICE = picker(0, 1, 2, 3, 0, 1, 2, 3)
_GRADIENT = picker(4, 5, 6, 7, 4, 5, 6, 7)
_OF_TWO, _AND_THE_THIRD = picker(1, 9, 0, 2, 10, 0, 3, 11), picker(0, 1, 9, 3, 4, 10, 6, 7)
"""A tensor row by row, without its last entry: from the sums along axes 0 and 1, then with that of axis 2."""
_CHANGE_2D, _CHANGE_3D = picker(0, 3, 4, 0, 0, 0, 0, 0), picker(0, 4, 5, 6, 0, 0, 0, 0)
"""Changes of velocity, moved to the lanes of the velocities."""
_FROM_1 = picker(8, 0, 1, 2, 3, 4, 5, 6)


@cache
def gather(dim: int, support: int, affine: bool = True):
    """The kernel that takes velocities and their slopes to the particles.

    ``gather(nodes, strides, lower, base, weight, gradient, hoop, cell_size, dt, flip, position, velocity, L,
    rate, affine, move, strain, has_affine)`` does, in one pass over the nodes of each particle,

    - if ``move``: x ← x + dt ṽ and v ← flip (v + Δṽ) + (1 - flip) ṽ;
    - if ``strain``: L_ij = Σ v_i ∂N/∂x_j, L_θθ = Σ v_r N/r where ``hoop`` has columns, and rate = tr L;
    - if ``has_affine``: C = Σ N v (x_node - x̄)ᵀ D⁻¹, with the diagonal D = Σ N (x_node - x̄)².

    N are the weights, and K_d = (lever (x_node - x̄)_d N_d, gradient ∂N_d/∂x_d) is the slope along axis d. All
    results come from the record of a node, (m, v, Δv), and from twice its first half, (m, v, m, v):

        v = Σ N0 N1 N2 (m, v, Δv),   s_0 = Σ K0 N1 N2 (m, v, m, v),   s_1 = Σ N0 K1 N2 (…),   s_2 = …

    In an axisymmetric scene the radius moves as r ← r (1 + dt D_θθ). The radially weighted average of v_r
    belongs to the centroid of the particle's ring, not to its middle, and near the axis the two differ. The
    hoop rate is exact for the middle, and a particle can never cross the axis.

    Args:
        dim, support: number of axes, and of the nodes along each that a shape function touches.
        affine: whether ``has_affine`` can be true; if not, slopes are gradients alone.
    """
    return _gather_2d(support, affine) if dim == 2 else _gather_3d(support, affine)


def _with_slopes(affine):
    """Functions that make a slope, that read the record and the sum which it multiplies, and that take the
    gradients out of the result.

    Without an affine part there are no levers: a slope is the gradient, of a whole record.
    """

    @inline()
    def slope(weight, gradient, p, axis, a, mean):
        of_gradient = spread(gradient[p, axis, a])
        return _SLOPE(spread((a - mean) * weight[p, axis, a]), of_gradient) if affine else of_gradient

    @inline()
    def record(nodes, i):
        return load_twice(nodes, i) if affine else load(nodes, i)

    @inline()
    def again(total):
        return _TWICE(total, total) if affine else total

    @inline()
    def gradients(total):
        return _GRADIENT(total, total) if affine else total

    return slope, record, again, gradients


def _gather_2d(support, keeps_affine):
    slope, record, again, gradients = _with_slopes(keeps_affine)

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
                m0, m1 = centroid(weight, p, 0, support), centroid(weight, p, 1, support)
                v = x = y = h = zero()
                for a in range(support):
                    row = (first + a * strides[0]) * NODE
                    rv = ry = zero()
                    for b in range(support):
                        rv = plus(rv, weight[p, 1, b], load(nodes, row + b * NODE))
                        ry = plus_product(
                            ry, slope(weight, gradient, p, 1, b, m1), record(nodes, row + b * NODE)
                        )
                    v = plus(v, weight[p, 0, a], rv)
                    x = plus_product(x, slope(weight, gradient, p, 0, a, m0), again(rv))
                    y = plus(y, weight[p, 0, a], ry)
                    if radial:
                        h = plus(h, hoop[p, a], rv)
                if strain:
                    gx, gy = gradients(x), gradients(y)
                    L[p, 0, 0], L[p, 0, 1] = lane(gx, 1), lane(gy, 1)
                    L[p, 1, 0], L[p, 1, 1] = lane(gx, 2), lane(gy, 2)
                    L[p, 2, 2] = lane(h, 1)
                    rate[p] = lane(gx, 1) + lane(gy, 2) + lane(h, 1)
                if keeps_affine and has_affine:
                    ax = scale(_inverse_moment(weight, p, 0, support, m0, cell_size), x)
                    ay = scale(_inverse_moment(weight, p, 1, support, m1, cell_size), y)
                    affine[p, 0, 0], affine[p, 0, 1] = lane(ax, 1), lane(ay, 1)
                    affine[p, 1, 0], affine[p, 1, 1] = lane(ax, 2), lane(ay, 2)
                if move:
                    position[p, 0] += dt * (position[p, 0] * lane(h, 1) if radial else lane(v, 1))
                    position[p, 1] += dt * lane(v, 2)
                    old = _FROM_1(load_first(velocity, 2 * p, 2), v)
                    new = plus(scale(1 - flip, v), flip, plus(old, 1.0, _CHANGE_2D(v, v)))
                    velocity[p, 0], velocity[p, 1] = lane(new, 1), lane(new, 2)

    return gather_2d


def _gather_3d(support, keeps_affine):
    slope, record, again, gradients = _with_slopes(keeps_affine)

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
                m0, m1 = centroid(weight, p, 0, support), centroid(weight, p, 1, support)
                m2 = centroid(weight, p, 2, support)
                v = x = y = z = zero()
                for a in range(support):
                    pv = py = pz = zero()
                    for b in range(support):
                        row = (first + a * strides[0] + b * strides[1]) * NODE
                        rv = rz = zero()
                        for c in range(support):
                            rv = plus(rv, weight[p, 2, c], load(nodes, row + c * NODE))
                            rz = plus_product(
                                rz, slope(weight, gradient, p, 2, c, m2), record(nodes, row + c * NODE)
                            )
                        pv = plus(pv, weight[p, 1, b], rv)
                        py = plus_product(py, slope(weight, gradient, p, 1, b, m1), again(rv))
                        pz = plus(pz, weight[p, 1, b], rz)
                    v = plus(v, weight[p, 0, a], pv)
                    x = plus_product(x, slope(weight, gradient, p, 0, a, m0), again(pv))
                    y = plus(y, weight[p, 0, a], py)
                    z = plus(z, weight[p, 0, a], pz)
                if strain:
                    gx, gy, gz = gradients(x), gradients(y), gradients(z)
                    store(L, 9 * p, _AND_THE_THIRD(_OF_TWO(gx, gy), gz))
                    L[p, 2, 2] = lane(gz, 3)
                    rate[p] = lane(gx, 1) + lane(gy, 2) + lane(gz, 3)
                if keeps_affine and has_affine:
                    ax = scale(_inverse_moment(weight, p, 0, support, m0, cell_size), x)
                    ay = scale(_inverse_moment(weight, p, 1, support, m1, cell_size), y)
                    az = scale(_inverse_moment(weight, p, 2, support, m2, cell_size), z)
                    store(affine, 9 * p, _AND_THE_THIRD(_OF_TWO(ax, ay), az))
                    affine[p, 2, 2] = lane(az, 3)
                if move:
                    position[p, 0] += dt * lane(v, 1)
                    position[p, 1] += dt * lane(v, 2)
                    position[p, 2] += dt * lane(v, 3)
                    old = _FROM_1(load_first(velocity, 3 * p, 3), v)
                    new = plus(scale(1 - flip, v), flip, plus(old, 1.0, _CHANGE_3D(v, v)))
                    velocity[p, 0], velocity[p, 1], velocity[p, 2] = lane(new, 1), lane(new, 2), lane(new, 3)

    return gather_3d


@cache
def gather_scalar(dim: int, support: int):
    """The kernel that takes Σ N value of a nodal field to the particles, into ``out (n,)``.

    Rows are read as four doubles. So ``field`` must be three doubles longer than the number of nodes.
    """

    @kernel()
    def gather_scalar(field, strides, lower, base, weight, out):
        n, last = len(base), dim - 1
        plane, line, low0, low1, low2 = strides[0], strides[1], lower[0], lower[1], lower[last]
        for chunk in prange(chunk_count(n)):
            for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
                first = (base[p, 0] - low0) * plane + (base[p, last] - low2)
                total = zero()
                if dim == 2:
                    for a in range(support):
                        total = plus(total, weight[p, 0, a], load_twice(field, first + a * plane))
                else:
                    first += (base[p, 1] - low1) * line
                    for a in range(support):
                        of_plane = zero()
                        for b in range(support):
                            row = load_twice(field, first + a * plane + b * line)
                            of_plane = plus(of_plane, weight[p, 1, b], row)
                        total = plus(total, weight[p, 0, a], of_plane)
                value = weight[p, last, 0] * lane(total, 0) + weight[p, last, 1] * lane(total, 1)
                if support > 2:
                    value += weight[p, last, 2] * lane(total, 2)
                if support > 3:
                    value += weight[p, last, 3] * lane(total, 3)
                out[p] = value

    return gather_scalar
