"""The apparent viscosity."""

from __future__ import annotations

import numpy as np

from mpmkit.contracts import Observed, ParticleField, hookimpl


class ApparentViscosity(ParticleField):
    """τ/γ̇ of the present stress and shear rate; ``nan`` where the material is not sheared."""

    name = "apparent-viscosity"
    api_version = 2
    citation = "none: the definition of a viscosity"
    unit = "Pa s"
    long_name = "apparent viscosity"

    def values(self, scene: Observed) -> np.ndarray:
        rate = scene.shear_rate
        return np.divide(scene.shear_stress, rate, out=np.full(len(rate), np.nan), where=rate > 0)


@hookimpl
def mpmkit_particle_fields() -> list[type[ParticleField]]:
    return [ApparentViscosity]
