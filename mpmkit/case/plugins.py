"""The plug-ins that a case uses, and what they know to fail where they are used as it does."""

from __future__ import annotations

from ..contracts import Plugin
from .model import Case

SCHEME = ("shape", "order", "velocity", "volumetric", "redistribution")
"""Kinds of plug-ins that a scheme is made of."""


def plugins_of(case: Case) -> list[tuple[str, Plugin]]:
    """Kind and plug-in, for every plug-in that the case uses."""
    scheme = case.scheme
    used = [
        (kind, getattr(scheme, kind))
        for kind in ("shape", "order", "velocity", "volumetric", "redistribution")
    ]
    for body in case.bodies:
        law = body.material.constitutive_law
        used.append(("law", law))
        if law.uses_equation_of_state:
            used.append(("equation_of_state", body.material.equation_of_state))
    return used


def cautions(case: Case) -> list[str]:
    """A sentence for each thing that is known to fail, those of several materials once."""
    return list(
        dict.fromkeys(sentence for _, plugin in plugins_of(case) for sentence in plugin.cautions(case))
    )
