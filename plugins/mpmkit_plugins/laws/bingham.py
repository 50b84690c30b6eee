"""Bingham's plastic, regularised."""

from collections.abc import Mapping

import numpy as np
from numba import prange

from mpmkit.contracts import GeneralisedNewtonianLaw, hookimpl, quantity
from mpmkit.kernels.compile import CHUNK, chunk_count, kernel

from .regularisation import yield_viscosity


class Bingham(GeneralisedNewtonianLaw):
    """mu(γ̇) = tau0 (1 - exp(-m γ̇)) / γ̇ + mu_p.

    In simple shear tau = tau0 (1 - exp(-m γ̇)) + mu_p γ̇, which is tau0 exp(-m γ̇) less than Bingham's law.
    """

    name = "bingham"
    api_version = 2
    citation = "Bingham, Fluidity and Plasticity (1922); Papanastasiou, J. Rheol. 31 (1987) 385-404"

    exact_form = "bingham-evp"

    yield_stress: float = quantity("Pa", "yield stress tau0", ge=0)
    plastic_viscosity: float = quantity("Pa s", "plastic viscosity mu_p", ge=0)
    regularisation: float = quantity("s", "Papanastasiou's exponent m", gt=0, default=1000.0)

    def apparent_viscosity(self, shear_rate: np.ndarray) -> np.ndarray:
        viscosity = np.empty(len(shear_rate))
        _viscosity(shear_rate, self.yield_stress, self.plastic_viscosity, self.regularisation, viscosity)
        return viscosity

    def yield_point(self, state: Mapping[str, np.ndarray]) -> float:
        return self.yield_stress


@kernel()
def _viscosity(shear_rate, yield_stress, plastic_viscosity, regularisation, viscosity):
    n = len(shear_rate)
    for c in prange(chunk_count(n)):
        rate = shear_rate[c * CHUNK : min(n, (c + 1) * CHUNK)]
        mu = viscosity[c * CHUNK : min(n, (c + 1) * CHUNK)]
        for p in range(len(rate)):
            mu[p] = yield_viscosity(rate[p], yield_stress, regularisation) + plastic_viscosity


@hookimpl
def mpmkit_laws():
    return [Bingham]
