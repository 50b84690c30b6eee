"""Volumetric rate and pressure averaged over the grid: the cure of locking."""

import numpy as np

from mpmkit.contracts import Operations, VolumetricTreatment, hookimpl, quantity


class NodalAverage(VolumetricTreatment):
    """f̄_p = Σ_n N_np f_n, f_n = Σ_q V_q N_nq f_q / Σ_q V_q N_nq, for volumetric rate and pressure.

    Each node is then nearly incompressible, and not each particle of a cell, so the velocity keeps enough
    degrees of freedom. V A = V Nᵀ W⁻¹ N V is symmetric, so no energy is created (see the contract).

    A cannot see variations between neighbouring particles, so nothing keeps their J together, and as
    particles move over the grid, more and more variations become invisible. So J tends to its average at the
    rate at which the material crosses cells, the mean speed over the cell size: it does not depend on the
    step, and nothing happens at rest. Where particles are too close, J tends with the same rate to the
    available volume.
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
