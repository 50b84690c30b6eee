"""Newton's fluid."""

import numpy as np

from mpmkit.contracts import GeneralisedNewtonianLaw, hookimpl, quantity


class Newtonian(GeneralisedNewtonianLaw):
    """mu(γ̇) = mu: tau = mu γ̇ in simple shear."""

    name = "newtonian"
    api_version = 2
    citation = "Batchelor, An Introduction to Fluid Dynamics (2000)"

    viscosity: float = quantity("Pa s", "dynamic viscosity mu", ge=0)

    def apparent_viscosity(self, shear_rate: np.ndarray) -> np.ndarray:
        return np.full_like(shear_rate, self.viscosity)


@hookimpl
def mpmkit_laws():
    return [Newtonian]
