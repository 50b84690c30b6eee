"""Herschel and Bulkley's fluid with an exact yield stress."""

import math

import numpy as np
from numba import prange

from mpmkit.contracts import ElastoviscoplasticLaw, hookimpl, quantity
from mpmkit.kernels.compile import CHUNK, chunk_count, kernel
from mpmkit.kernels.elementary import SMALLEST, exp, fused, log

ROUNDING = 1e-15
HALF_LN2 = 0.5 * math.log(2)
MOST_ITERATIONS = 60


class HerschelBulkleyEVP(ElastoviscoplasticLaw):
    """tau = tau0 + k γ̇^n beyond the yield stress, elastic below it.

    The return mapping solves k γ̇^n + G Δt γ̇ = tau* - tau0, a particle at a time.
    """

    name = "herschel-bulkley-evp"
    api_version = 2
    citation = (
        "Herschel & Bulkley, Kolloid-Z. 39 (1926) 291-300; "
        "Saramito, J. Non-Newton. Fluid Mech. 158 (2009) 154-161"
    )

    yield_stress: float = quantity("Pa", "yield stress tau0", ge=0)
    consistency: float = quantity("Pa s^n", "consistency k", ge=0)
    flow_index: float = quantity("1", "flow index n", gt=0, le=10)

    def flow_curve(self, shear_rate: np.ndarray) -> np.ndarray:
        return self.yield_stress + self.consistency * shear_rate**self.flow_index

    def relaxed_stress(self, trial: np.ndarray, stiffness: float) -> np.ndarray:
        if self.consistency == 0:
            return np.minimum(trial, self.yield_stress)
        stress = np.empty(len(trial))
        k, n = self.consistency, self.flow_index
        _relaxed_stress(trial, stiffness, self.yield_stress, k, n, _iterations(n), stress)
        return stress


def _iterations(flow_index: float) -> int:
    """Steps of Newton's method that bring its error e from the start's, ln 2 / (2 min(n, 1)) at the most,
    below rounding, by the bound on its square, e ← (n - 1)² / (8 min(n, 1)) e²."""
    least = min(flow_index, 1)
    error, curvature = HALF_LN2 / least, (flow_index - 1) ** 2 / (8 * least)
    for steps in range(1, MOST_ITERATIONS):
        error = min(curvature * error, 0.5) * error
        if error < ROUNDING:
            return steps
    return MOST_ITERATIONS


@kernel()
def _relaxed_stress(trial, stiffness, yield_stress, consistency, flow_index, iterations, stress):
    """Newton's method on ln(k e^(n y) + G Δt e^y) = ln(tau* - tau0) with y = ln γ̇.

    In logarithms the curve is all but straight, its slope between 1 and n, and convex. Where the larger term
    alone would be the sum, it is between 0 and ln 2 too high; the start is half of that lower. All particles
    take the same number of steps, each a loop without a branch, so that several are solved at once;
    ``stress`` holds y until then.
    """
    ln_k, ln_g, per_index = math.log(consistency), math.log(stiffness), 1 / flow_index
    n = len(trial)
    for c in prange(chunk_count(n)):
        given = trial[c * CHUNK : min(n, (c + 1) * CHUNK)]
        found = stress[c * CHUNK : min(n, (c + 1) * CHUNK)]
        target = np.empty(len(given))
        for p in range(len(given)):
            target[p] = log(max(given[p] - yield_stress, SMALLEST))
            found[p] = min((target[p] - HALF_LN2 - ln_k) * per_index, target[p] - HALF_LN2 - ln_g)
        for _ in range(iterations):
            for p in range(len(given)):
                a, b = fused(flow_index, found[p], ln_k), found[p] + ln_g
                less = exp(-abs(a - b))  # the smaller term over the larger one
                value = max(a, b) + log(1.0 + less)
                slope = flow_index + less if a > b else fused(flow_index, less, 1.0)  # times 1 + less
                found[p] -= (value - target[p]) * (1.0 + less) / slope
        for p in range(len(given)):
            excess = given[p] - yield_stress
            # Never more than without flow; and what is no number stays none.
            flows = yield_stress + min(exp(fused(flow_index, found[p], ln_k)), excess)
            found[p] = flows if excess > 0.0 else given[p]


@hookimpl
def mpmkit_laws():
    return [HerschelBulkleyEVP]
