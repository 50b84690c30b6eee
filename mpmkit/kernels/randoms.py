"""Random numbers that depend on nothing but a particle and a time.

A generator with a state would give other numbers when particles are sorted anew, or when a run is resumed.
"""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, inline, kernel

ODD = np.uint64(0x9E3779B97F4A7C15)
"""2⁶⁴ over the golden ratio: its multiples are far apart."""
FIRST, SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
S27, S30, S31, S11 = np.uint64(27), np.uint64(30), np.uint64(31), np.uint64(11)
HALF_RANGE = 2.0**-52


@inline()
def mixed(bits):
    """The bits of a number so mixed that neighbours have nothing in common.

    The function is that of SplitMix64 (Steele, Lea & Flood, 2014, doi:10.1145/2660193.2660195).
    """
    bits = (bits ^ (bits >> S30)) * FIRST
    bits = (bits ^ (bits >> S27)) * SECOND
    return bits ^ (bits >> S31)


@kernel()
def fill_uniform(number, time, out):
    """Fill ``out (n, dim)`` with numbers from -1 to 1, all equally probable.

    Args:
        number: ``(n,)``, unsigned: the numbers of the particles.
        time: the bits of the time, unsigned.
    """
    n, dim = out.shape
    of_time = mixed(time + ODD)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            bits = mixed(number[p] + of_time)
            for d in range(dim):
                bits += ODD
                out[p, d] = float(mixed(bits) >> S11) * HALF_RANGE - 1.0


def uniform(number: np.ndarray, time: float, dim: int) -> np.ndarray:
    """Numbers from -1 to 1, ``(n, dim)``, that depend on a particle's number, on the time and on the axis."""
    out = np.empty((len(number), dim))
    with np.errstate(over="ignore"):  # products are meant modulo 2⁶⁴; uncompiled, numpy would warn
        fill_uniform(number.astype(np.uint64), np.float64(time).view(np.uint64), out)
    return out
