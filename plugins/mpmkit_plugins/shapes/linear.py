"""Linear hat functions: the original Material Point Method."""

import math

import numpy as np
from numba import prange

from mpmkit.contracts import ShapeFunction, hookimpl
from mpmkit.kernels.compile import CHUNK, chunk_count, kernel


class Linear(ShapeFunction):
    """N = 1 - ξ and ξ at the two nodes of the cell, ξ the position in it; the particle is a point."""

    name = "linear"
    api_version = 2
    citation = "Sulsky, Chen & Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179-196"
    support = 2
    smooth = False

    def fill(self, position, half_size, cell_size, base, weight, gradient) -> None:
        _fill(position, 1 / cell_size, base, weight, gradient)

    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop) -> None:
        # A point has no extent to average over: the tables are those of ``fill``, and N/r is taken at it.
        _fill(radius[:, None], 1 / cell_size, base[:, None], weight[:, None], gradient[:, None])
        np.divide(weight, radius[:, None], out=hoop)


@kernel()
def _fill(x, inverse_cell, base, weight, gradient):
    n, dim = x.shape
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            for d in range(dim):
                cell = math.floor(x[p, d] * inverse_cell)
                ξ = x[p, d] * inverse_cell - cell
                base[p, d] = cell
                weight[p, d, 0], weight[p, d, 1] = 1 - ξ, ξ
                gradient[p, d, 0], gradient[p, d, 1] = -inverse_cell, inverse_cell


@hookimpl
def mpmkit_shape_functions():
    return [Linear]
