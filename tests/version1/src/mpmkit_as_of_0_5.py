"""Plug-ins written for version 1 of the contracts, as of mpmkit 0.5.0; they pass their tests there."""

import math
from collections.abc import Mapping

import numpy as np

from mpmkit.contracts import (
    ConstitutiveLaw,
    Motion,
    Operations,
    StateVariable,
    UpdateOrder,
    VelocityUpdate,
    VolumetricTreatment,
    hookimpl,
    quantity,
)


class OldOil(ConstitutiveLaw):
    """sigma' = 2 mu D', and a memory of how far it was stretched."""

    name = "old-oil"
    api_version = 1
    citation = "Batchelor, An Introduction to Fluid Dynamics (2000)"
    state = {"stretch": StateVariable("1", "integral of tr D over time")}

    viscosity: float = quantity("Pa s", "viscosity mu", gt=0)

    def update_stress(
        self, motion: Motion, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        L = motion.velocity_gradient
        rate = np.trace(L, axis1=1, axis2=2)
        state["stretch"] += dt * rate
        for k, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))):
            stress[:, k] = self.viscosity * (L[:, i, j] + L[:, j, i] - (i == j) * 2 * rate / 3)

    def largest_viscosity(self, largest_shear_rate: float) -> float:
        return self.viscosity

    def strain_energy(
        self, motion: Motion, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray | float:
        return 0.0


class OldUSF(UpdateOrder):
    """Update stress first."""

    name = "old-usf"
    api_version = 1
    citation = "Bardenhagen, J. Comput. Phys. 180 (2002) 383-403"

    def step(self, ops: Operations, dt: float) -> None:
        ops.map_to_grid(forces=False)
        ops.update_velocity_gradient()
        ops.update_stress(dt)
        ops.map_forces()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt)


class OldBlend(VelocityUpdate):
    """v ← α (v + Δṽ) + (1 - α) ṽ with α = exp(-rate dt)."""

    name = "old-blend"
    api_version = 1
    citation = "Stomakhin et al., ACM Trans. Graph. 32 (2013) 102"

    rate: float = quantity("1/s", "decay", ge=0, default=10.0)

    def map_to_particles(self, ops: Operations, dt: float) -> None:
        ops.advance(dt, flip=math.exp(-self.rate * dt))


class OldAverage(VolumetricTreatment):
    """The average over the grid; at the nodes it looks at masses as well, which changes nothing."""

    name = "old-average"
    api_version = 1
    citation = "Love & Sulsky, Int. J. Numer. Meth. Eng. 65 (2006) 1608-1638"

    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        ops.nodes_to_particles(ops.particles_to_nodes(field, measure="mass"))
        return ops.average(field, measure="volume")

    def relaxation_rate(self, ops: Operations) -> float:
        return ops.mean_speed / ops.cell_size


@hookimpl
def mpmkit_laws():
    return [OldOil]


@hookimpl
def mpmkit_update_orders():
    return [OldUSF]


@hookimpl
def mpmkit_velocity_updates():
    return [OldBlend]


@hookimpl
def mpmkit_volumetric_treatments():
    return [OldAverage]
