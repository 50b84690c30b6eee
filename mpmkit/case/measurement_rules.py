"""The rules for measurements of a case."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence

from ..output.summary import UNITS
from .formula import FUNCTIONS
from .measurements import NAMES, SELF, TAKEN, functions, measured
from .model import Case

NAME = re.compile(r"[a-z][a-z0-9_]*")


def check_measurements(case: Case) -> None:
    """Raise ValueError with one sentence for the first measurement that is not valid.

    Every formula is evaluated once with test numbers instead of a scene.
    """
    for name in case.measurements:
        if not NAME.fullmatch(name) or name in {*NAMES, *TAKEN, *FUNCTIONS, *UNITS}:
            raise ValueError(
                f"{SELF} has one called '{name}'; a name must be of lower-case letters, digits and '_', "
                "begin with a letter, and not be that of a variable, a figure or a function"
            )
    measured(case.measurements, _Numbers(), functions(_Asked(case)))


class _Asked:
    """The functions that look at a scene, as they check what they are given; each returns 1."""

    def __init__(self, case: Case) -> None:
        self._case, self._axes = case, case.space_.axes
        faces = [name for name, kind in case.grid.faces.items() if _is_wall(kind)]
        self._walls = {*case.walls, *faces}

    def depth(self, *place: float) -> float:
        axes = self._axes[:-1]
        if not 1 <= len(place) <= len(axes) or not self._within(place):
            (low, high), *across = self._domain()
            also = "".join(f" and, if you like, one along y, from {a:g} to {b:g} m" for a, b in across)
            raise ValueError(f"depth takes one place along {axes[0]}, from {low:g} to {high:g} m{also}")
        return 1.0

    def surface(self, *place: float) -> float:
        axes = self._axes[:-1]
        if len(place) != len(axes) or not self._within(place):
            places = [
                f"one place along {axis}, from {low:g} to {high:g} m"
                for axis, (low, high) in zip(axes, self._domain(), strict=True)
            ]
            raise ValueError(f"surface takes {' and '.join(places)}")
        return 1.0

    def _domain(self) -> list[list[float]]:
        """Ends of the horizontal axes."""
        return [self._case.grid.domain[axis] for axis in self._axes[:-1]]

    def _within(self, place: Sequence[float]) -> bool:
        return all(low <= x <= high for x, (low, high) in zip(place, self._domain(), strict=False))

    def width(self, *place: float) -> float:
        axes = self._axes
        low, high = self._case.grid.domain[axes[0]]
        if len(axes) != 3 or len(place) != 1 or not low <= place[0] <= high:
            raise ValueError(
                f"width takes one place along {axes[0]}, from {low:g} to {high:g} m, in a scene in 3d"
            )
        return 1.0

    def front(self, *given: float) -> float:
        if given:
            raise ValueError("front takes nothing: write front()")
        return 1.0

    def force(self, wall: str = "", axis: str = "", *more: str) -> float:
        if more or wall not in self._walls or axis not in self._axes:
            raise ValueError(
                f"force takes the name of a wall ({_listed(self._walls)}) and an axis "
                f"({_listed(self._axes)}), in quotes"
            )
        return 1.0

    def torque(self, wall: str = "", *more: str) -> float:
        if more or wall not in self._walls or len(self._axes) != 2 or self._case.space_.radial:
            raise ValueError(
                f"torque takes the name of a wall ({_listed(self._walls)}) in a plane strain scene"
            )
        return 1.0

    def outflow(self, sink: str = "", *more: str) -> float:
        if more or sink not in self._case.sinks:
            raise ValueError(f"outflow takes the name of a sink ({_listed(self._case.sinks)}), in quotes")
        return 1.0


class _Numbers(dict[str, float]):
    """Test numbers instead of a scene; all differ, so that differences are not zero."""

    def __init__(self) -> None:
        super().__init__({name: 1.0 + math.sqrt(2 + place) for place, name in enumerate(NAMES)})


def _is_wall(kind: object) -> bool:
    return kind not in ("periodic", "open", "symmetry")


def _listed(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in sorted(names)) or "there is none"
