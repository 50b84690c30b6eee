"""The state variables of the laws of a case, as frames and histories name them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from ..contracts import ConstitutiveLaw
from ..contracts.law import initial_state
from ..output.variables import PARTICLE_VARIABLES, ParticleVariable
from ..registry.blame import blaming_plugins
from .model import Case

SINCE_0_10 = {"age"}
"""Particle fields that a state variable or a field of a case may be called as well; theirs is then meant."""
TAKEN = {*PARTICLE_VARIABLES, "speed", "half_size", "body", "particle", "time", "component"} - SINCE_0_10
"""Names of the other fields in frames and histories."""


LAW = "law."
"""Before the name of a state variable."""


def field_name(state: str) -> str:
    """Name of the field of a state variable."""
    return f"{LAW}{state}"


def former_names(case: Case) -> dict[str, str]:
    """Names of state variables in ``particle_history`` up to 0.9, and their present names.

    A case with the old names stays valid, and its history also contains them.
    """
    names = {
        f"{name}_of_{law.name}" if name in TAKEN else name: field_name(name)
        for law in laws_of(case)
        for name in law.state
    }
    taken = PARTICLE_VARIABLES.keys() - SINCE_0_10
    return {former: name for former, name in names.items() if former not in taken}


def state_variables(case: Case) -> dict[str, ParticleVariable]:
    """Every state variable of a case by the name of its field; its components are in one flat dimension.

    Laws that have a state variable of the same name share the field; its value is NaN
    for particles of other laws.

    Raises:
        PluginStop: a law declares a variable that is not valid.
        ValueError: two laws have a state variable of one name and of different units or components.
    """
    found: dict[str, ParticleVariable] = {}
    for law in laws_of(case):
        with blaming_plugins([("law", law)]):
            initial_state(law, 1)  # raises an error if a variable is wrong
        for name, variable in law.state.items():
            field = field_name(name)
            trailing = (f"{field}_component",) if variable.shape else ()
            new = ParticleVariable(variable.unit, variable.description, trailing, flat(variable.shape))
            old = found.setdefault(field, new)
            if (old.units, old.shape) != (new.units, new.shape):
                raise ValueError(
                    f"two laws of the case have a state variable '{field}' of different units or components; "
                    "they cannot be in one case"
                )
    return found


def particle_variables(case: Case) -> dict[str, ParticleVariable]:
    """Every particle field that the history of a case may keep, by all its names."""
    fields = {
        name: ParticleVariable(
            field.unit, field.long_name, (f"{name}_component",) if field.shape else (), flat(field.shape)
        )
        for name, field in case.output.fields.items()
    }
    states = state_variables(case)
    former = {
        name: replace(states[now], trailing=tuple(f"{name}_component" for _ in states[now].trailing))
        for name, now in former_names(case).items()
    }
    return PARTICLE_VARIABLES | former | states | fields


def flat(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Lengths of the trailing dimensions of a field of a shape: its components are in one of them."""
    return (math.prod(shape),) if shape else ()


def laws_of(case: Case) -> Iterable[ConstitutiveLaw]:
    """The law of each body and source."""
    return (material.constitutive_law for material in case.materials.values())
