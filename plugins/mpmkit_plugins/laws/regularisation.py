"""Papanastasiou's regularised yield stress and the power law, on arrays of shear rates."""

import numpy as np
from numba import prange

from mpmkit.kernels.compile import CHUNK, chunk_count, kernel
from mpmkit.kernels.elementary import expm1, power


def yield_viscosity(shear_rate, yield_stress, regularisation):
    """tau0 (1 - exp(-m γ̇)) / γ̇, which tends to tau0 m at rest."""
    viscosity = np.empty(len(shear_rate))
    _yield_viscosity(shear_rate, yield_stress, regularisation, viscosity)
    return viscosity


def power_viscosity(shear_rate, consistency, flow_index, regularisation):
    """k γ̇^(n-1). A shear-thinning fluid (n < 1) has no bound at rest; below 1/m it keeps its value at 1/m."""
    viscosity = np.empty(len(shear_rate))
    least = 1 / regularisation if flow_index < 1 else 0.0
    _power_viscosity(shear_rate, consistency, flow_index, least, viscosity)
    return viscosity


@kernel()
def _yield_viscosity(shear_rate, yield_stress, regularisation, viscosity):
    n = len(shear_rate)
    for c in prange(chunk_count(n)):
        rate = shear_rate[c * CHUNK : min(n, (c + 1) * CHUNK)]
        mu = viscosity[c * CHUNK : min(n, (c + 1) * CHUNK)]
        for p in range(len(rate)):
            mu[p] = -yield_stress * expm1(-regularisation * rate[p]) / rate[p]


@kernel()
def _power_viscosity(shear_rate, consistency, flow_index, least, viscosity):
    n = len(shear_rate)
    for c in prange(chunk_count(n)):
        rate = shear_rate[c * CHUNK : min(n, (c + 1) * CHUNK)]
        mu = viscosity[c * CHUNK : min(n, (c + 1) * CHUNK)]
        for p in range(len(rate)):
            mu[p] = consistency * power(max(rate[p], least), flow_index - 1.0)
