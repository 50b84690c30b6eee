"""The state variables of the laws of a case, as frames and histories name them."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ..contracts import ConstitutiveLaw
from ..contracts.law import initial_state
from ..output.variables import PARTICLE_VARIABLES, ParticleVariable
from ..registry.blame import blaming_plugins
from .model import Case

TAKEN = {*PARTICLE_VARIABLES, "speed", "half_size", "body", "particle", "time", "component"}
"""Names of what frames and histories hold beside them."""


def field_name(law: ConstitutiveLaw, state: str) -> str:
    """Name of the field of a state variable: its own, or ``<name>_of_<law>`` where that is taken."""
    return f"{state}_of_{law.name}" if state in TAKEN else state


def state_variables(case: Case) -> dict[str, ParticleVariable]:
    """Every state variable of a case by the name of its field; its components are in one flat dimension.

    Laws that have a state variable of the same name share the field; particles of other laws have none, and
    are not a number there.

    Raises:
        PluginStop: a law declares a variable that cannot be one.
        ValueError: two laws have a state variable of one name and of different units or components.
    """
    found: dict[str, ParticleVariable] = {}
    for law in laws_of(case):
        with blaming_plugins([("law", law)]):
            initial_state(law, 1)  # says what is wrong with a variable, if anything is
        for name, variable in law.state.items():
            field, size = field_name(law, name), math.prod(variable.shape)
            trailing = (f"{field}_component",) if variable.shape else ()
            shape = (size,) if variable.shape else ()
            new = ParticleVariable(variable.unit, variable.description, trailing, shape)
            old = found.setdefault(field, new)
            if (old.units, old.shape) != (new.units, new.shape):
                raise ValueError(
                    f"two laws of the case have a state variable '{field}' of different units or components; "
                    "they cannot be in one case"
                )
    return found


def laws_of(case: Case) -> Iterable[ConstitutiveLaw]:
    """The law of each body."""
    return (body.material.constitutive_law for body in case.bodies)
