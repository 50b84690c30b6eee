"""Herschel and Bulkley's fluid, regularised."""

from collections.abc import Mapping

import numpy as np
from numba import prange

from mpmkit.contracts import GeneralisedNewtonianLaw, hookimpl, quantity
from mpmkit.kernels.compile import CHUNK, chunk_count, kernel
from mpmkit.kernels.elementary import power

from .regularisation import yield_viscosity


class HerschelBulkley(GeneralisedNewtonianLaw):
    """mu(γ̇) = tau0 (1 - exp(-m γ̇)) / γ̇ + k γ̇^(n-1): eq. 7 of Ferreira et al.

    In simple shear tau = tau0 (1 - exp(-m γ̇)) + k γ̇^n. Below the yield stress it creeps at about
    tau / (tau0 m), and at rest its viscosity is tau0 m, which bounds the time step: a large m is exact and
    slow. Where n < 1, the power law keeps below γ̇ = 1/m the viscosity that it has there.
    """

    name = "herschel-bulkley"
    api_version = 2
    citation = "Herschel & Bulkley, Kolloid-Z. 39 (1926) 291-300; Papanastasiou, J. Rheol. 31 (1987) 385-404"

    exact_form = "herschel-bulkley-evp"

    yield_stress: float = quantity("Pa", "yield stress tau0", ge=0)
    consistency: float = quantity("Pa s^n", "consistency k", ge=0)
    flow_index: float = quantity("1", "flow index n", gt=0, le=10)
    regularisation: float = quantity("s", "Papanastasiou's exponent m", gt=0, default=1000.0)

    def apparent_viscosity(self, shear_rate: np.ndarray) -> np.ndarray:
        viscosity, m = np.empty(len(shear_rate)), self.regularisation
        least = 1 / m if self.flow_index < 1 else 0.0
        _viscosity(shear_rate, self.yield_stress, self.consistency, self.flow_index, m, least, viscosity)
        return viscosity

    def yield_point(self, state: Mapping[str, np.ndarray]) -> float:
        return self.yield_stress


@kernel()
def _viscosity(shear_rate, yield_stress, consistency, flow_index, regularisation, least, viscosity):
    n = len(shear_rate)
    for c in prange(chunk_count(n)):
        rate = shear_rate[c * CHUNK : min(n, (c + 1) * CHUNK)]
        mu = viscosity[c * CHUNK : min(n, (c + 1) * CHUNK)]
        for p in range(len(rate)):
            power_law = consistency * power(max(rate[p], least), flow_index - 1.0)
            mu[p] = yield_viscosity(rate[p], yield_stress, regularisation) + power_law


@hookimpl
def mpmkit_laws():
    return [HerschelBulkley]
