"""Herschel and Bulkley's fluid with an exact yield stress."""

import math

import numba
import numpy as np

from mpmkit.contracts import ElastoviscoplasticLaw, hookimpl, quantity


class HerschelBulkleyEVP(ElastoviscoplasticLaw):
    """tau = tau0 + k γ̇^n beyond the yield stress, elastic below it.

    The return mapping solves k γ̇^n + G Δt γ̇ = tau* - tau0, a particle at a time.
    """

    name = "herschel-bulkley-evp"
    api_version = 1
    citation = (
        "Herschel & Bulkley, Kolloid-Z. 39 (1926) 291-300; "
        "Saramito, J. Non-Newton. Fluid Mech. 158 (2009) 154-161"
    )

    yield_stress: float = quantity("Pa", "yield stress tau0", ge=0)
    consistency: float = quantity("Pa s^n", "consistency k", ge=0)
    flow_index: float = quantity("1", "flow index n", gt=0)

    def flow_curve(self, shear_rate: np.ndarray) -> np.ndarray:
        return self.yield_stress + self.consistency * shear_rate**self.flow_index

    def relaxed_stress(self, trial: np.ndarray, stiffness: float) -> np.ndarray:
        return _relaxed_stress(trial, stiffness, self.yield_stress, self.consistency, self.flow_index)


@numba.vectorize(cache=True)
def _relaxed_stress(trial, stiffness, yield_stress, consistency, flow_index):
    """Newton's method from the side on which it cannot overshoot.

    The left-hand side is convex for n >= 1, where it starts above the root, at the smaller of what either
    term alone would give; and concave for n < 1, where it starts below, at what either gives of half.
    """
    excess = trial - yield_stress
    if excess <= 0.0:
        return trial
    if consistency == 0.0:
        return yield_stress
    part = excess if flow_index >= 1.0 else 0.5 * excess
    # The smaller of (part / k)^(1/n) and part / (G Δt), by logarithms: the first may be beyond any number.
    rate = math.exp(min(math.log(part / consistency) / flow_index, math.log(part / stiffness)))
    if rate < 1e-300:  # a flow index of nearly nothing: the stress rises as it would without flow
        return trial
    for _ in range(50):
        power = consistency * rate**flow_index
        change = (excess - power - stiffness * rate) / (flow_index * power / rate + stiffness)
        rate += change
        if abs(change) <= 1e-13 * rate:
            break
    return yield_stress + consistency * rate**flow_index


@hookimpl
def mpmkit_laws():
    return [HerschelBulkleyEVP]
