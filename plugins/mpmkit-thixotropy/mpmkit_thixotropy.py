"""Roussel's thixotropic concrete as a plug-in of mpmkit: a flow curve, and how its structure changes."""

from mpmkit.contracts import ElastoviscoplasticLawWithState, StateVariable, hookimpl, quantity


class Thixotropic(ElastoviscoplasticLawWithState):
    """tau = (1 + λ) tau0 + mu_p γ̇ beyond the yield stress,  dλ/dt = 1/T - α λ γ̇.

    At rest the yield stress grows by A_thix = tau0 / T; below it the material is elastic. The structure is
    integrated by backward Euler, λ = (λ_old + Δt/T) / (1 + α γ̇ Δt), so that no step is too long for it.
    """

    name = "thixotropic"
    api_version = 2
    citation = "Roussel, Cem. Concr. Res. 36 (2006) 1797-1806"
    state = {"structure": StateVariable("1", "state of flocculation λ", initial="initial_structure")}

    yield_stress: float = quantity("Pa", "yield stress tau0 without structure", ge=0)
    plastic_viscosity: float = quantity("Pa s", "plastic viscosity mu_p", ge=0)
    flocculation_time: float = quantity("s", "time T in which the yield stress grows by tau0 at rest", gt=0)
    breakdown: float = quantity("1", "α, the inverse of the strain that breaks the structure", ge=0)
    initial_structure: float = quantity(
        "1", "λ at the start, such as a rest of λ T leaves", ge=0, default=0.0
    )

    def flow_curve_at(self, shear_rate, state):
        return (1 + state["structure"]) * self.yield_stress + self.plastic_viscosity * shear_rate

    def update_state(self, state, shear_rate, dt):
        state["structure"] += dt / self.flocculation_time
        state["structure"] /= 1 + self.breakdown * shear_rate * dt


@hookimpl
def mpmkit_laws():
    return [Thixotropic]
