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
def shear_squared(L, p):
    """2 D':D' of one particle, 1/s²."""
    mean = (L[p, 0, 0] + L[p, 1, 1] + L[p, 2, 2]) / 3
    xx, yy, zz = L[p, 0, 0] - mean, L[p, 1, 1] - mean, L[p, 2, 2] - mean
    yz, xz, xy = L[p, 1, 2] + L[p, 2, 1], L[p, 0, 2] + L[p, 2, 0], L[p, 0, 1] + L[p, 1, 0]
    return 2 * (xx * xx + yy * yy + zz * zz) + yz * yz + xz * xz + xy * xy


@kernel()
def _shear_rate(L, floor, rate):
    n = len(L)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            rate[p] = max(math.sqrt(shear_squared(L, p)), floor)


@kernel()
def viscous_stress(L, viscosity, stress):
    """Extra stress 2 mu (D - tr(D)/3 I) into ``stress (n, 6)``."""
    n = len(L)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            mu = viscosity[p]
            mean = (L[p, 0, 0] + L[p, 1, 1] + L[p, 2, 2]) / 3
            stress[p, 0] = 2 * mu * (L[p, 0, 0] - mean)
            stress[p, 1] = 2 * mu * (L[p, 1, 1] - mean)
            stress[p, 2] = 2 * mu * (L[p, 2, 2] - mean)
            stress[p, 3] = mu * (L[p, 1, 2] + L[p, 2, 1])
            stress[p, 4] = mu * (L[p, 0, 2] + L[p, 2, 0])
            stress[p, 5] = mu * (L[p, 0, 1] + L[p, 1, 0])


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
