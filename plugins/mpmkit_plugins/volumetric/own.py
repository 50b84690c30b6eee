"""The particle's own volume and pressure."""

import numpy as np

from mpmkit.contracts import Operations, VolumetricTreatment, hookimpl


class Own(VolumetricTreatment):
    """Every particle keeps its own volumetric rate and pressure: the paper's choice.

    Near incompressibility each particle of a cell puts a constraint on it. Where the velocity must vary
    within the cell, as on a stick floor, that leaves it no freedom, and the material locks
    (docs/findings.md).
    """

    name = "own"
    api_version = 2
    citation = "Sulsky, Chen & Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179-196"

    def cautions(self, case) -> list[str]:
        if "stick" not in case.grid.faces.values():
            return []
        return [
            "volumetric 'own' locks at a stick face, where the velocity must vary within a cell; "
            "'nodal-average' does not"
        ]

    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        return field


@hookimpl
def mpmkit_volumetric_treatments():
    return [Own]
