"""A thin sheet of a Bingham fluid on a stick floor: Huppert's equation with a yield stress, finite volumes.

Where the sheet is yielded, up to Y = h - tau0/(rho g |h'|), it shears; above it goes as a plug:

    q = -sign(h') rho g |h'|/(6 mu) Y² (3 h - Y),   r dh/dt + d(r q)/dr = 0

No inertia, no stress but shear: right where the sheet is much wider than high. Time goes with the viscosity.
"""

from __future__ import annotations

import numba
import numpy as np
from closed_forms import BOTTOM, GRAVITY, HEIGHT, TOP, VOLUME

WIDTH, CELLS = 0.3, 400
"""Of the radius, m, that is resolved, and into how many rings."""


def t500_film(yield_stress: float, density: float) -> float:
    """Time to a spread of 500 mm over the plastic viscosity, 1/Pa, of a cone released at once."""
    radius = (np.arange(CELLS) + 0.5) * WIDTH / CELLS
    height = HEIGHT * np.clip((BOTTOM - radius) / (BOTTOM - TOP), 0, 1)
    height *= VOLUME / np.sum(2 * np.pi * radius * height * WIDTH / CELLS)
    return _spread(height, yield_stress, density * GRAVITY, WIDTH / CELLS, 0.25)


@numba.njit
def _spread(h, yield_stress, weight, dr, until):  # pragma: no cover
    cells = len(h)
    q = np.zeros(cells + 1)
    time, end = 0.0, 0
    while end * dr < until:
        fastest = 1e-12
        for i in range(1, cells):
            slope, mean = (h[i] - h[i - 1]) / dr, (h[i] + h[i - 1]) / 2
            yielded = mean - yield_stress / (weight * abs(slope)) if slope != 0.0 else 0.0
            q[i] = 0.0
            if yielded > 0.0:
                mobility = weight / 6 * yielded * yielded * (3 * mean - yielded)
                q[i] = -slope * mobility
                rigid = mean - yielded
                fastest = max(fastest, mobility + weight / 2 * yielded * (2 * mean - yielded) * rigid)
        step = 0.2 * dr * dr / fastest
        for i in range(cells):
            h[i] -= step * ((i + 1) * q[i + 1] - i * q[i]) / ((i + 0.5) * dr)
        time += step
        end = cells
        while h[end - 1] < 1e-4:
            end -= 1
    return time
