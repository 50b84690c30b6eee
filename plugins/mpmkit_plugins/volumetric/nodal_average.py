"""Volumetric rate and pressure averaged over the grid: the cure of locking."""

import numpy as np

from mpmkit.contracts import Operations, VolumetricTreatment, hookimpl, quantity


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

    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        return ops.average(field)

    def relaxation_rate(self, ops: Operations) -> float:
        return self.relaxation * ops.mean_speed / ops.cell_size


@hookimpl
def mpmkit_volumetric_treatments():
    return [NodalAverage]
