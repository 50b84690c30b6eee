"""The particle's own volume and pressure."""

import numpy as np

from mpmkit.contracts import Operations, VolumetricTreatment, hookimpl


class Own(VolumetricTreatment):
    """Every particle keeps its own volumetric rate and pressure: the seed's choice, and it locks.

    With more particles than a cell has volumetric modes, near incompressibility leaves a cell no freedom.
    """

    name = "own"
    api_version = 1
    citation = "Sulsky, Chen & Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179-196"

    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        return field


@hookimpl
def mpmkit_volumetric_treatments():
    return [Own]
