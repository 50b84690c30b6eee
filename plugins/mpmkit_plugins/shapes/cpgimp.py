"""Contiguous-particle GIMP: linear hats averaged over the particle's box."""

import math
from typing import Literal

from numba import prange
from pydantic import Field

from mpmkit.contracts import ShapeFunction, hookimpl
from mpmkit.kernels.compile import CHUNK, chunk_count, inline, kernel


class CpGIMP(ShapeFunction):
    """N̄ = 1/(2 l_p) ∫ N dx and its gradient over [x_p - l_p, x_p + l_p]: eqs. 2 and 3 of Ferreira et al.

    The averages are exact. A box is at most one cell wide and so covers at most two cells, three nodes.
    In an axisymmetric scene the radial ones are weighted with r, N̄ = ∫ N r dr / ∫ r dr (Nairn & Guilkey).
    """

    name = "cpgimp"
    api_version = 1
    citation = (
        "Bardenhagen & Kober, CMES 5 (2004) 477-496; "
        "Nairn & Guilkey, Int. J. Numer. Meth. Eng. 101 (2015) 127-147"
    )
    support = 3

    domain: Literal["fixed", "stretch", "volume"] = Field(
        default="fixed",
        description="how the particle's box follows the deformation: not at all (uGIMP), by the stretch "
        "U_ii, or as the cube root of the volume ratio (square root in two dimensions)",
    )

    @property
    def particle_domain(self) -> str:
        return self.domain

    def fill(self, position, half_size, cell_size, base, weight, gradient) -> None:
        _fill(position, half_size, 1 / cell_size, base, weight, gradient)

    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop) -> None:
        _fill_radial(radius, half_size, cell_size, base, weight, gradient, hoop)


@kernel()
def _fill(x, l, inverse_cell, base, weight, gradient):
    n, dim = x.shape
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            for d in range(dim):
                begin = (x[p, d] - l[p, d]) * inverse_cell
                cell = math.floor(begin)
                width = 2 * l[p, d] * inverse_cell
                # In units of cells from node 0 the box is [a, b]; up to 1 it lies in the first cell, beyond
                # in the second. A hat is linear in each, so that the midpoint gives its mean exactly.
                a = begin - cell
                b = a + width
                first = (min(b, 1.0) - a) / width  # fractions of the box in either cell
                second = 1.0 - first
                ξ = 0.5 * (a + min(b, 1.0))  # midpoints of the two parts, each in its cell
                η = 0.5 * (max(b, 1.0) - 1.0)
                base[p, d] = cell
                weight[p, d, 0] = first * (1 - ξ)
                weight[p, d, 1] = first * ξ + second * (1 - η)
                weight[p, d, 2] = second * η
                gradient[p, d, 0] = -first * inverse_cell
                gradient[p, d, 1] = (first - second) * inverse_cell
                gradient[p, d, 2] = second * inverse_cell


@inline()
def _ring_averages(cell, a, b):
    """∫ r dr, ∫ ξ r dr and ∫ dr over [a, b] in cell ``cell``, all in units of cells; ξ = r - cell."""
    mid, length = 0.5 * (a + b), b - a
    spread = length * length / 12
    area = length * (cell + mid)
    return area, area * mid + length * spread, length


@kernel()
def _fill_radial(radius, l, cell_size, base, weight, gradient, hoop):
    n = len(radius)
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            begin = max(radius[p] - l[p], 0.0) / cell_size  # a box that would cross the axis ends there
            end = (radius[p] + l[p]) / cell_size
            cell = math.floor(begin)
            a, b = begin - cell, end - cell
            area1, moment1, length1 = _ring_averages(cell, a, min(b, 1.0))
            area2, moment2, length2 = _ring_averages(cell + 1, 0.0, max(b, 1.0) - 1.0)
            area = area1 + area2
            per_area = 1 / (area * cell_size)
            mean1, mean2 = 0.5 * (a + min(b, 1.0)), 0.5 * length2
            base[p] = cell
            weight[p, 0] = (area1 - moment1) / area
            weight[p, 1] = (moment1 + area2 - moment2) / area
            weight[p, 2] = moment2 / area
            gradient[p, 0] = -area1 * per_area
            gradient[p, 1] = (area1 - area2) * per_area
            gradient[p, 2] = area2 * per_area
            hoop[p, 0] = length1 * (1 - mean1) * per_area
            hoop[p, 1] = (length1 * mean1 + length2 * (1 - mean2)) * per_area
            hoop[p, 2] = length2 * mean2 * per_area


@hookimpl
def mpmkit_shape_functions():
    return [CpGIMP]
