"""Bingham's plastic with an exact yield stress."""

import numpy as np

from mpmkit.contracts import ElastoviscoplasticLaw, hookimpl, quantity


class BinghamEVP(ElastoviscoplasticLaw):
    """tau = tau0 + mu_p γ̇ beyond the yield stress, elastic below it.

    The return mapping is in closed form: tau = tau0 + mu_p (tau* - tau0) / (mu_p + G Δt).
    """

    name = "bingham-evp"
    api_version = 2
    citation = "Bingham, Fluidity and Plasticity (1922); Saramito, J. Non-Newton. Fluid Mech. 145 (2007) 1-14"

    yield_stress: float = quantity("Pa", "yield stress tau0", ge=0)
    plastic_viscosity: float = quantity("Pa s", "plastic viscosity mu_p", ge=0)

    def flow_curve(self, shear_rate: np.ndarray) -> np.ndarray:
        return self.yield_stress + self.plastic_viscosity * shear_rate

    def relaxed_stress(self, trial: np.ndarray, stiffness: float) -> np.ndarray:
        excess = np.maximum(trial - self.yield_stress, 0.0)
        viscous = self.plastic_viscosity / (self.plastic_viscosity + stiffness)
        return np.minimum(trial, self.yield_stress) + viscous * excess


@hookimpl
def mpmkit_laws():
    return [BinghamEVP]
