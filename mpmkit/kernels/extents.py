"""How far the material reaches along an axis, within the domain and the resolution of the grid."""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, kernel


@kernel()
def extents(position, box, axes, extent, periodic, longest):
    """Lowest x - l and highest x + l along the first ``axes`` axes, ``(axes, 2)``, m, in the domain.

    The half-size l of a box counts up to ``longest``, and the part of a box beyond a face is cut off: see
    ``solver.measures``. Particles outside the domain, or not finite, are left out; if none is left, the ends
    are ±∞. Along a periodic axis a position may have any value, and nothing is cut off.

    Args:
        position, box: ``(n, dim)``, m.
        axes: number of axes, from the first.
        extent: ``(dim,)``, m, upper corner of the domain; the lower one is 0.
        periodic: ``(dim,)``, whether an axis is periodic.
        longest: m, largest half-size that counts.
    """
    n, dim = position.shape
    chunks = chunk_count(n)
    ends = np.empty((chunks, axes, 2))
    for c in prange(chunks):
        for a in range(axes):
            ends[c, a, 0], ends[c, a, 1] = np.inf, -np.inf
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            inside = True
            for d in range(dim):
                x = position[p, d]
                inside &= ((x >= 0.0) & (x <= extent[d])) | (periodic[d] & np.isfinite(x))
            if inside:
                for a in range(axes):
                    half = min(box[p, a], longest)
                    ends[c, a, 0] = min(ends[c, a, 0], position[p, a] - half)
                    ends[c, a, 1] = max(ends[c, a, 1], position[p, a] + half)
    found = np.empty((axes, 2))
    for a in range(axes):
        low, high = np.inf, -np.inf
        for c in range(chunks):
            low, high = min(low, ends[c, a, 0]), max(high, ends[c, a, 1])
        if not periodic[a] and low <= high:
            low, high = max(low, 0.0), min(high, extent[a])
        found[a, 0], found[a, 1] = low, high
    return found
