"""Bingham's plastic, regularised."""

import numpy as np

from mpmkit.contracts import GeneralisedNewtonianLaw, hookimpl, quantity

from .regularisation import yield_viscosity


class Bingham(GeneralisedNewtonianLaw):
    """mu(γ̇) = tau0 (1 - exp(-m γ̇)) / γ̇ + mu_p.

    In simple shear tau = tau0 (1 - exp(-m γ̇)) + mu_p γ̇: short of Bingham's by tau0 exp(-m γ̇).
    """

    name = "bingham"
    api_version = 1
    citation = "Bingham, Fluidity and Plasticity (1922); Papanastasiou, J. Rheol. 31 (1987) 385-404"

    exact_form = "bingham-evp"

    yield_stress: float = quantity("Pa", "yield stress tau0", ge=0)
    plastic_viscosity: float = quantity("Pa s", "plastic viscosity mu_p", ge=0)
    regularisation: float = quantity("s", "Papanastasiou's exponent m", gt=0, default=1000.0)

    def apparent_viscosity(self, shear_rate: np.ndarray) -> np.ndarray:
        return yield_viscosity(shear_rate, self.yield_stress, self.regularisation) + self.plastic_viscosity


@hookimpl
def mpmkit_laws():
    return [Bingham]
