"""Papanastasiou's regularised yield stress and the power law, element by element."""

import math

import numba


@numba.vectorize(cache=True)
def yield_viscosity(shear_rate, yield_stress, regularisation):
    """tau0 (1 - exp(-m γ̇)) / γ̇, which tends to tau0 m at rest."""
    return -yield_stress * math.expm1(-regularisation * shear_rate) / shear_rate


@numba.vectorize(cache=True)
def power_viscosity(shear_rate, consistency, flow_index, regularisation):
    """k γ̇^(n-1). A shear-thinning fluid (n < 1) has no bound at rest; below 1/m it keeps its value at 1/m."""
    if flow_index < 1.0:
        shear_rate = max(shear_rate, 1.0 / regularisation)
    return consistency * shear_rate ** (flow_index - 1.0)
