"""No redistribution: particles go where the grid takes them."""

from mpmkit.contracts import Redistribution, hookimpl


class NoRedistribution(Redistribution):
    """The scheme as published, and solids, whose particles keep their neighbours."""

    name = "none"
    api_version = 2
    citation = "Sulsky, Chen & Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179-196"

    def redistribute(self, ops, time) -> None:
        pass


@hookimpl
def mpmkit_redistributions():
    return [NoRedistribution]
