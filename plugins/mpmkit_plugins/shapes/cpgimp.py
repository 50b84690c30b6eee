"""Contiguous-particle GIMP: linear hats averaged over the particle's box."""

import math
from typing import Literal

import numpy as np
from numba import prange
from pydantic import Field

from mpmkit.contracts import ShapeFunction, hookimpl
from mpmkit.kernels.compile import CHUNK, chunk_count, inline, kernel


class CpGIMP(ShapeFunction):
    """N̄ = 1/(2 l_p) ∫ N dx and its gradient over [x_p - l_p, x_p + l_p]: eqs. 2 and 3 of Ferreira et al.

    The averages are exact. A box covers at most two cells, three nodes: one that is wider than a cell counts
    as one cell wide.
    In an axisymmetric scene the radial ones are weighted with r, N̄ = ∫ N r dr / ∫ r dr (Nairn & Guilkey).
    """

    name = "cpgimp"
    api_version = 2
    citation = (
        "Bardenhagen & Kober, CMES 5 (2004) 477-496; "
        "Nairn & Guilkey, Int. J. Numer. Meth. Eng. 101 (2015) 127-147"
    )
    support = 3

    domain: Literal["strain", "fixed", "stretch", "volume"] = Field(
        default="strain",
        description="how the particle's box follows the deformation: by the normal strain along each axis, "
        "not at all (uGIMP), by the stretch U_ii, or as the cube root of the volume ratio (square root in "
        "two dimensions)",
    )

    @property
    def particle_domain(self) -> str:
        return self.domain

    def fill(self, position, half_size, cell_size, base, weight, gradient) -> None:
        if weight.flags.c_contiguous:  # all axes are alike: one loop over all numbers
            flat = (array.reshape(-1) for array in (position, half_size, base, weight, gradient))
            _fill_whole(*flat, 1 / cell_size)
        else:
            _fill(position, half_size, base, weight, gradient, 1 / cell_size)

    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop) -> None:
        _fill_radial(radius, half_size, cell_size, base, weight, gradient, hoop)


@inline()
def _averages(x, l, inverse_cell):
    """First node of a box, the averages of the three hats over it, and the parts of it in its two cells."""
    width = min(2 * l * inverse_cell, 1.0)
    begin = x * inverse_cell - 0.5 * width
    cell = np.floor(begin)
    # In units of cells from node 0 the box is [a, b]; up to 1 it lies in the first cell, beyond in the
    # second. A hat is linear in each, so that the midpoint gives its mean exactly.
    a = begin - cell
    b = a + width
    # A node that is barely touched divides one small number by another. Both must be small in the same way,
    # weight ~ gradient²: fractions and midpoints come from the same differences, and how far a midpoint is
    # from the end of its cell is not left to be 1 - ξ, which rounds.
    end = min(b, 1.0)
    to_edge, beyond = end - a, max(b, 1.0) - 1.0
    first, second = to_edge / width, beyond / width
    ξ, η = a + 0.5 * to_edge, 0.5 * beyond  # midpoints of the two parts, each in its cell
    left = first * ((1 - end) + 0.5 * to_edge)
    return np.int32(cell), left, first * ξ + second * (1 - η), second * η, first, second


@kernel()
def _fill_whole(x, l, base, weight, gradient, inverse_cell):
    """Of flat arrays: the compiler then sees that no two entries overlap, and takes several at once."""
    n = len(x)
    for chunk in prange(chunk_count(n)):
        begin, end = chunk * CHUNK, min(n, (chunk + 1) * CHUNK)
        x_, l_, base_ = x[begin:end], l[begin:end], base[begin:end]
        N, slope = weight[3 * begin : 3 * end], gradient[3 * begin : 3 * end]
        for k in range(len(x_)):
            base_[k], left, middle, right, first, second = _averages(x_[k], l_[k], inverse_cell)
            N[3 * k], N[3 * k + 1], N[3 * k + 2] = left, middle, right
            slope[3 * k] = -first * inverse_cell
            slope[3 * k + 1] = (first - second) * inverse_cell
            slope[3 * k + 2] = second * inverse_cell


@kernel()
def _fill(x, l, base, weight, gradient, inverse_cell):
    n, dim = x.shape
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            for d in range(dim):
                base[p, d], left, middle, right, first, second = _averages(x[p, d], l[p, d], inverse_cell)
                weight[p, d, 0], weight[p, d, 1], weight[p, d, 2] = left, middle, right
                gradient[p, d, 0] = -first * inverse_cell
                gradient[p, d, 1] = (first - second) * inverse_cell
                gradient[p, d, 2] = second * inverse_cell


@inline()
def _ring_averages(cell, a, b):
    """∫ r dr, ∫ (1 - ξ) r dr, ∫ ξ r dr and ∫ dr over [a, b] in cell ``cell``, ξ = r - cell, in cells.

    The second is not left to be the difference of the others, nor 1 - ξ that of 1 and the midpoint, which
    where they are tiny would be rounding.
    """
    mid, length = 0.5 * (a + b), b - a
    spread = length * length / 12
    area = length * (cell + mid)
    left = area * (0.5 * ((1 - a) + (1 - b))) - length * spread
    return area, left, area * mid + length * spread, length


@kernel()
def _fill_radial(radius, l, cell_size, base, weight, gradient, hoop):
    n, inverse_cell = len(radius), 1 / cell_size
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            half = min(l[p], 0.5 * cell_size)
            begin = max(radius[p] - half, 0.0) * inverse_cell  # a box that would cross the axis ends there
            end = (radius[p] + half) * inverse_cell
            cell = math.floor(begin)
            a, b = begin - cell, end - cell
            area1, left1, right1, length1 = _ring_averages(cell, a, min(b, 1.0))
            area2, left2, right2, length2 = _ring_averages(cell + 1, 0.0, max(b, 1.0) - 1.0)
            of_ring = 1 / (area1 + area2)
            per_area = of_ring * inverse_cell
            mean1, mean2 = 0.5 * (a + min(b, 1.0)), 0.5 * length2
            short1 = 0.5 * ((1 - a) + (1 - min(b, 1.0)))  # 1 - mean1
            base[p] = cell
            weight[p, 0] = left1 * of_ring
            weight[p, 1] = (right1 + left2) * of_ring
            weight[p, 2] = right2 * of_ring
            gradient[p, 0] = -area1 * per_area
            gradient[p, 1] = (area1 - area2) * per_area
            gradient[p, 2] = area2 * per_area
            hoop[p, 0] = length1 * short1 * per_area
            hoop[p, 1] = (length1 * mean1 + length2 * (1 - mean2)) * per_area
            hoop[p, 2] = length2 * mean2 * per_area


@hookimpl
def mpmkit_shape_functions():
    return [CpGIMP]
