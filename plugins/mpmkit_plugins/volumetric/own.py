"""The particle's own volume and pressure."""

import numpy as np

from mpmkit.contracts import Operations, VolumetricTreatment, hookimpl


class Own(VolumetricTreatment):
    """Every particle keeps its own volumetric rate and pressure: the paper's choice.

    In a nearly incompressible material each particle of a cell is a constraint. If the velocity must vary
    within the cell, as on a stick floor, no degree of freedom is left, and the material locks
    (docs/findings.md).
    """

    name = "own"
    api_version = 2
    citation = "Sulsky, Chen & Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179-196"

    def cautions(self, case) -> list[str]:
        said = []
        if any(_meets(case, axis) for axis in case.space_.axes):
            said.append(
                "volumetric 'own' locks at a stick face where material spreads or is pressed against it, so "
                "that rows of particles in a cell come closer at different rates; 'nodal-average' does not"
            )
        if not case.scheme.shape.smooth and any(map(_is_fluid, case.bodies)):
            said.append(
                f"volumetric 'own' with shape '{case.scheme.shape.name}' throws out particles of some flows: "
                "6 of 36 slumps were stopped; 'nodal-average', or shape 'cpgimp', does not"
            )
        return said

    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        return field


def _is_fluid(body) -> bool:
    return body.material.constitutive_law.uses_equation_of_state


def _meets(case, axis) -> bool:
    """Whether material at a stick face normal to an axis can do anything but slide along it, as in a film."""
    faces = case.grid.faces
    if "stick" not in (faces.get(f"{axis}_min"), faces.get(f"{axis}_max")):
        return False
    return any(faces.get(f"{a}_min") != "periodic" for a in case.space_.axes if a != axis)


@hookimpl
def mpmkit_volumetric_treatments():
    return [Own]
