"""Whether the members of a study solve the same problem, so that their differences are numerical errors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from .members import Member

SETTINGS = {
    "space", "until", "scheme", "cell_size", "domain", "particles_per_cell", "law", "form", "regularisation",
    "sound_speed", "output", "measurements", "description",
}  # fmt: skip
"""Keys of a case that say how its problem is solved and what is recorded. The name of a law is one of them,
because one material has an exact and a regularised law; the parameters of laws belong to the problem."""
SYMMETRY = "symmetry"
"""A plane of symmetry only makes the computed part of the problem smaller."""


def solve_one_problem(members: Iterable[Member]) -> bool:
    """Whether all members have the same bodies, materials, boundaries and forces."""
    problems = [problem(member.data) for member in members]
    return all(one == problems[0] for one in problems)


def problem(case: Mapping[str, Any]) -> Any:
    """The content of a resolved case without its settings; vectors have three components.

    The axes of a plane or axisymmetric scene are the first and the third of a 3-D scene.
    """
    flat = case["space"] != "3d"

    def physical(value: Any) -> Any:
        if isinstance(value, Mapping):
            return {
                key: physical(entry)
                for key, entry in value.items()
                if key not in SETTINGS and entry is not None and entry != SYMMETRY
            }
        if isinstance(value, list):
            if flat and len(value) == 2 and all(isinstance(entry, int | float) for entry in value):
                return [value[0], 0.0, value[1]]
            return [physical(entry) for entry in value]
        return value

    return physical(case)
