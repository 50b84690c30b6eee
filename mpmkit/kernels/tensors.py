"""Tensor algebra on whole particle arrays: rates, stress, deformation. Tensors are (n, 3, 3).

Symmetric tensors are stored as (n, 6) in the order xx, yy, zz, yz, xz, xy.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, inline, kernel


def shear_rate(velocity_gradient: np.ndarray, floor: float = 0.0) -> np.ndarray:
    """γ̇ = √(2 D':D') of the deviatoric rate of deformation D', 1/s, ``(n,)``, at least ``floor``."""
    rate = np.empty(len(velocity_gradient))
    _shear_rate(velocity_gradient, floor, rate)
    return rate


@inline()
def squares_of_shear(L, square):
    """2 D':D' of each particle, 1/s², from the gradients of all, one after the other, in one flat array: the
    compiler then sees that they do not overlap, and takes several at once.
    """
    for p in range(len(square)):
        k = 9 * p
        mean = (L[k] + L[k + 4] + L[k + 8]) / 3
        xx, yy, zz = L[k] - mean, L[k + 4] - mean, L[k + 8] - mean
        yz, xz, xy = L[k + 5] + L[k + 7], L[k + 2] + L[k + 6], L[k + 1] + L[k + 3]
        square[p] = 2 * (xx * xx + yy * yy + zz * zz) + yz * yz + xz * xz + xy * xy


@kernel()
def _shear_rate(L, floor, rate):
    n, gradients = len(L), L.reshape(-1)
    for c in prange(chunk_count(n)):
        begin, end = c * CHUNK, min(n, (c + 1) * CHUNK)
        found = rate[begin:end]
        squares_of_shear(gradients[9 * begin : 9 * end], found)
        for k in range(len(found)):
            found[k] = max(math.sqrt(found[k]), floor)


@kernel()
def viscous_stress(L, viscosity, stress):
    """Extra stress 2 mu (D - tr(D)/3 I) into ``stress (n, 6)``."""
    n, gradients, stresses = len(L), L.reshape(-1), stress.reshape(-1)
    for c in prange(chunk_count(n)):
        begin, end = c * CHUNK, min(n, (c + 1) * CHUNK)
        l, s, mus = gradients[9 * begin : 9 * end], stresses[6 * begin : 6 * end], viscosity[begin:end]
        for p in range(len(mus)):
            k, i, mu = 9 * p, 6 * p, mus[p]
            mean = (l[k] + l[k + 4] + l[k + 8]) / 3
            s[i] = 2 * mu * (l[k] - mean)
            s[i + 1] = 2 * mu * (l[k + 4] - mean)
            s[i + 2] = 2 * mu * (l[k + 8] - mean)
            s[i + 3] = mu * (l[k + 5] + l[k + 7])
            s[i + 4] = mu * (l[k + 2] + l[k + 6])
            s[i + 5] = mu * (l[k + 1] + l[k + 3])


@kernel()
def deform(L, dt, F):
    """F ← (I + dt L) F."""
    n = len(L)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            for j in range(3):
                a, b, d = F[p, 0, j], F[p, 1, j], F[p, 2, j]
                F[p, 0, j] = a + dt * (L[p, 0, 0] * a + L[p, 0, 1] * b + L[p, 0, 2] * d)
                F[p, 1, j] = b + dt * (L[p, 1, 0] * a + L[p, 1, 1] * b + L[p, 1, 2] * d)
                F[p, 2, j] = d + dt * (L[p, 2, 0] * a + L[p, 2, 1] * b + L[p, 2, 2] * d)


@kernel()
def determinant(F, out):
    """det F, ``(n,)``."""
    n = len(F)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            out[p] = (
                F[p, 0, 0] * (F[p, 1, 1] * F[p, 2, 2] - F[p, 1, 2] * F[p, 2, 1])
                - F[p, 0, 1] * (F[p, 1, 0] * F[p, 2, 2] - F[p, 1, 2] * F[p, 2, 0])
                + F[p, 0, 2] * (F[p, 1, 0] * F[p, 2, 1] - F[p, 1, 1] * F[p, 2, 0])
            )
