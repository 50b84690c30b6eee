"""No redistribution: particles go where the grid takes them."""

import math

from mpmkit.contracts import GeneralisedNewtonianLaw, Redistribution, hookimpl

LONG = 40.0
"""Time, in units of √(h/g), after which flows that do not come to rest may be wrong. In measurements, films
were wrong from 65 on (4.7 s), and oscillating water from 45 on."""
RESTS_YIELD, RESTS_VISCOSITY = 10.0, 100.0
"""Yield stress, Pa, and viscosity, Pa s; material with a larger one comes to rest before that time."""


class NoRedistribution(Redistribution):
    """Particles move only with the grid: the scheme as published, and right for solids."""

    name = "none"
    api_version = 2
    citation = "Sulsky, Chen & Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179-196"

    def cautions(self, case) -> list[str]:
        laws = [body.material.constitutive_law for body in case.bodies]
        fluids = [law for law in laws if law.uses_equation_of_state]
        free_fall = math.sqrt(case.height / (math.hypot(*case.gravity_vector) or math.inf))
        if not fluids or not free_fall or case.end < LONG * free_fall:
            return []
        if not _is_driven(case) and not any(map(_is_thin, fluids)):
            return []
        return [
            "redistribution 'none' does not keep positions and volumes of a fluid consistent for longer "
            f"than about {LONG * free_fall:.2g} s of flow: films lost half of their speed, and oscillating "
            "water half of its height; with scheme.splitting films became a third too fast; "
            "scheme.redistribution 'even' keeps them consistent"
        ]

    def redistribute(self, ops, time) -> None:
        pass


def _is_driven(case) -> bool:
    """Whether gravity acts along a periodic axis, so that the flow has no end."""
    gravity = zip(case.space_.axes, case.gravity_vector, strict=True)
    return any(g and case.grid.faces.get(f"{axis}_min") == "periodic" for axis, g in gravity)


def _is_thin(law) -> bool:
    """Whether neither a yield stress nor a viscosity is large enough to bring the fluid to rest."""
    if getattr(law, "yield_stress", 0.0) >= RESTS_YIELD:
        return False
    viscous = isinstance(law, GeneralisedNewtonianLaw)
    return not viscous or law.viscosity_at(1.0) < RESTS_VISCOSITY


@hookimpl
def mpmkit_redistributions():
    return [NoRedistribution]
