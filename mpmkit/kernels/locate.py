"""Where particles are: inside the domain, and still near the slab and window they were sorted into."""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from .compile import CHUNK, chunk_count, kernel

HERE, STRAYED, LOST = range(3)
"""All particles in place; one has drifted too far from its slab or window; one is outside or not finite."""


@kernel()
def locate(
    position, half_size, extent, inverse_cell, slabs, slab_width, first_slab, window_low, window_high,
    verdicts,
):  # fmt: skip
    """Check all particles and their domains. Returns the worst verdict and the particle that is ``LOST``.

    A particle may drift anywhere between the cells ``window_low`` and ``window_high``, but along the first
    axis no more than one cell beyond its slab. ``verdicts`` is scratch, two integers a chunk.
    """
    n, dim = position.shape
    chunks = chunk_count(n)
    for c in prange(chunks):
        worst, who = HERE, -1
        begin = c * CHUNK
        group, slab = _slab_of(slabs, begin)
        for p in range(begin, min(n, begin + CHUNK)):
            while p >= slabs[group, slab + 1]:
                slab += 1
                if slab == slabs.shape[1] - 1:
                    slab = 0
                    group += 1
            for d in range(dim):
                x = position[p, d]
                # Also true of a NaN; and a box that is none would send the weights anywhere.
                if not (0.0 <= x <= extent[d] and 0.0 < half_size[p, d] < np.inf):
                    if worst != LOST:
                        worst, who = LOST, p
                    continue
                cell = int(x * inverse_cell)
                low, high = window_low[d], window_high[d]
                if d == 0:
                    low = max(low, (first_slab + slab) * slab_width - 1)
                    high = min(high, (first_slab + slab + 1) * slab_width)
                if (cell < low or cell > high) and worst == HERE:
                    worst = STRAYED
        verdicts[c, 0], verdicts[c, 1] = worst, who
    worst, who = HERE, -1
    for c in range(chunks):
        if verdicts[c, 0] > worst:
            worst, who = verdicts[c, 0], verdicts[c, 1]
    return worst, who


@njit(cache=True)
def _slab_of(slabs, p):
    """Group and slab that hold particle p."""
    for g in range(slabs.shape[0]):
        for s in range(slabs.shape[1] - 1):
            if slabs[g, s] <= p < slabs[g, s + 1]:
                return g, s
    return 0, 0


@kernel()
def wrap(position, axis, length):
    """Bring particles that left a periodic axis back in at the other end."""
    n = len(position)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            x = position[p, axis]
            if x < 0.0 or x >= length:
                position[p, axis] = x - np.floor(x / length) * length


@kernel()
def largest_speed(velocity, scratch):
    """Largest |v|, m/s. ``scratch`` has one entry a chunk."""
    n, dim = velocity.shape
    chunks = chunk_count(n)
    for c in prange(chunks):
        worst = 0.0
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            squared = 0.0
            for d in range(dim):
                squared += velocity[p, d] ** 2
            worst = max(worst, squared)
        scratch[c] = worst
    worst = 0.0
    for c in range(chunks):
        worst = max(worst, scratch[c])
    return np.sqrt(worst)
