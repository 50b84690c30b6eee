"""Volumetric rate and pressure averaged over the grid: the cure of locking."""

import math

import numpy as np

from mpmkit.contracts import GeneralisedNewtonianLaw, Operations, VolumetricTreatment, hookimpl, quantity

LONG = 40.0
"""Times √(h/g) after which fluids without a yield stress were seen to lose volume, at the earliest."""
HOLDS_RELAXATION = 1.0
"""E-folds a cell that hold the places of particles, where boxes are split so that they tell of crowding."""
HOLDS_YIELD, HOLDS_VISCOSITY = 10.0, 100.0
"""Yield stress, Pa, and viscosity, Pa s, at which none was lost (docs/stability/volumes_and_energy.md)."""


class NodalAverage(VolumetricTreatment):
    """f̄_p = Σ_n N_np f_n, f_n = Σ_q V_q N_nq f_q / Σ_q V_q N_nq, for volumetric rate and pressure.

    A node is then the one that is nearly incompressible, and not each particle of a cell, which leaves the
    velocity its freedom. V A = V Nᵀ W⁻¹ N V is symmetric: see the contract for what that is good for.

    A cannot see what varies from particle to particle within its reach, so that nothing holds J together
    there; as particles move over the grid, some of what it did see gets lost in that blind spot. J is
    therefore drawn to its average at the rate at which the material crosses cells, a mean speed over a cell:
    independent of the step, and nothing at rest. The same rate holds the places: where particles crowd, J is
    drawn to the volume that is there.
    """

    name = "nodal-average"
    api_version = 2
    citation = (
        "Love & Sulsky, Int. J. Numer. Meth. Eng. 65 (2006) 1608-1638, carried over to rate and pressure"
    )

    relaxation: float = quantity(
        "1",
        "departures of J from its average that decay per cell that the material crosses",
        ge=0,
        default=1.0,
    )

    def cautions(self, case) -> list[str]:
        if case.scheme.refinement.name == "split" and self.relaxation >= HOLDS_RELAXATION:
            return []
        if case.scheme.redistribution.equal_boxes:  # which holds the volume in another way
            return []
        free_fall = math.sqrt(case.height / (math.hypot(*case.gravity_vector) or math.inf))
        thin = any(_is_thin(body.material.constitutive_law) for body in case.bodies)
        if not thin or not free_fall or case.until < LONG * free_fall:
            return []
        return [
            "volumetric 'nodal-average' loses volume in a fluid of little viscosity and yield stress that "
            f"swings for longer than {LONG * free_fall:.2g} s, unless scheme.refinement is 'split' and its "
            f"relaxation at least {HOLDS_RELAXATION:g}, or scheme.redistribution is 'even'"
        ]

    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        return ops.average(field)

    def relaxation_rate(self, ops: Operations) -> float:
        return self.relaxation * ops.mean_speed / ops.cell_size


def _is_thin(law) -> bool:
    """Whether neither yield stress nor viscosity are known to be enough."""
    if not law.uses_equation_of_state or getattr(law, "yield_stress", 0.0) >= HOLDS_YIELD:
        return False
    viscous = isinstance(law, GeneralisedNewtonianLaw)
    return not viscous or law.viscosity_at(1.0) < HOLDS_VISCOSITY


@hookimpl
def mpmkit_volumetric_treatments():
    return [NodalAverage]
