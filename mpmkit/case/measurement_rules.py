"""The rules for measurements of a case."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from ..output.summary import UNITS
from .formula import FUNCTIONS
from .measurements import NAMES, SELF, TAKEN, functions, measured
from .model import Case

NAME = re.compile(r"[a-z][a-z0-9_]*")


def check_measurements(case: Case) -> None:
    """Raise ValueError with one sentence for the first measurement that is not valid.

    Every formula is evaluated once with test numbers instead of a scene.
    """
    axes = case.space_.axes
    walls = {*case.walls, *(name for name, kind in case.grid.faces.items() if _is_wall(kind))}

    def depth(x: float = math.nan, *more: float) -> float:
        low, high = case.grid.domain[axes[0]]
        if more or not low <= x <= high:
            raise ValueError(f"depth takes one place along {axes[0]}, from {low:g} to {high:g} m")
        return 1.0

    def front(*given: float) -> float:
        if given:
            raise ValueError("front takes nothing: write front()")
        return 1.0

    def force(wall: str = "", axis: str = "", *more: str) -> float:
        if more or wall not in walls or axis not in axes:
            raise ValueError(
                f"force takes the name of a wall ({_listed(walls)}) and an axis ({_listed(axes)}), in quotes"
            )
        return 1.0

    def torque(wall: str = "", *more: str) -> float:
        if more or wall not in walls or len(axes) != 2 or case.space_.radial:
            raise ValueError(f"torque takes the name of a wall ({_listed(walls)}) in a plane strain scene")
        return 1.0

    for name in case.measurements:
        if not NAME.fullmatch(name) or name in {*NAMES, *TAKEN, *FUNCTIONS, *UNITS}:
            raise ValueError(
                f"{SELF} has one called '{name}'; a name must be of small letters, digits and '_', first a "
                "letter, and not that of a variable, a figure or a function that there is"
            )
    measured(case.measurements, _Numbers(), functions(depth, front, force, torque))


class _Numbers(dict[str, float]):
    """Test numbers instead of a scene; all differ, so that differences are not zero."""

    def __init__(self) -> None:
        super().__init__({name: 1.0 + math.sqrt(2 + place) for place, name in enumerate(NAMES)})


def _is_wall(kind: object) -> bool:
    return kind not in ("periodic", "open", "symmetry")


def _listed(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in sorted(names)) or "there is none"
