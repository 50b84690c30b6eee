"""The plug-ins that a case uses, and their known problems in this case."""

from __future__ import annotations

from ..contracts import Plugin
from ..contracts.version1 import deprecation
from ..registry.audit import require_sentences
from ..registry.blame import blaming_plugins
from .model import Case
from .shapes import shapes_in

SCHEME = ("shape", "order", "velocity", "volumetric", "redistribution", "refinement")
"""Kinds of plug-ins that a scheme is made of."""


def plugins_of(case: Case) -> list[tuple[str, Plugin]]:
    """Kind and plug-in, for every plug-in that the case uses."""
    scheme = case.scheme
    used = [(kind, getattr(scheme, kind)) for kind in SCHEME]
    for material in case.materials.values():
        law = material.constitutive_law
        used.append(("law", law))
        if law.uses_equation_of_state:
            used.append(("equation_of_state", material.equation_of_state))
    used += [("body_shape", body.shape) for body in case.bodies]
    used += [("initial_field", field) for body in case.bodies for field in body.initial.values()]
    for wall in case.walls.values():
        used += [("surface", wall.surface), ("contact", wall.contact)]
        used += [("body_shape", shape) for shape in shapes_in(wall.surface).values()]
    used += [("source", one.source) for one in case.sources.values()]
    used += [("body_force", force) for force in case.forces.values()]
    used += [("sink", sink) for sink in case.sinks.values()]
    used += [("diagnostic", diagnostic) for diagnostic in case.output.diagnostics.values()]
    used += [("particle_field", field) for field in case.output.fields.values()]
    return used


def cautions(case: Case) -> list[str]:
    """One sentence for each known problem, and for each plug-in of an older version.

    Raises:
        PluginStop: a plug-in is at fault.
    """
    used = plugins_of(case)
    with blaming_plugins(used):
        said = [require_sentences(plugin, "cautions", plugin.cautions(case)) for _, plugin in used]
    old = filter(None, (deprecation(plugin) for _, plugin in used))
    return list(dict.fromkeys([*(sentence for sentences in said for sentence in sentences), *old]))
