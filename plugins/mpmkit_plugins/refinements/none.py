"""No refinement: as many particles at the end as at the start."""

from mpmkit.contracts import Refinement, hookimpl


class NoRefinement(Refinement):
    """The scheme as published: particles are neither split nor merged."""

    name = "none"
    api_version = 2
    citation = "Sulsky, Chen & Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179-196"


@hookimpl
def mpmkit_refinements():
    return [NoRefinement]
