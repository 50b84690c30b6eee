"""Casson's law as a plug-in of mpmkit."""

import numpy as np

from mpmkit.contracts import GeneralisedNewtonianLaw, hookimpl, quantity


class Casson(GeneralisedNewtonianLaw):
    """√mu(γ̇) = √(tau0 (1 - exp(-m γ̇)) / γ̇) + √mu_c, regularised after Papanastasiou."""

    name = "casson"
    api_version = 2
    citation = "Casson, in Mill (ed.), Rheology of Disperse Systems (1959) 84-104"

    yield_stress: float = quantity("Pa", "yield stress tau0", ge=0)
    casson_viscosity: float = quantity("Pa s", "Casson viscosity mu_c", ge=0)
    regularisation: float = quantity("s", "Papanastasiou's exponent m", gt=0, default=1000.0)

    def apparent_viscosity(self, shear_rate: np.ndarray) -> np.ndarray:
        plastic = -self.yield_stress * np.expm1(-self.regularisation * shear_rate) / shear_rate
        return (np.sqrt(plastic) + np.sqrt(self.casson_viscosity)) ** 2


@hookimpl
def mpmkit_laws():
    return [Casson]
