"""Base class of the built-in surfaces: their motion, and the time in which they are present."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from pydantic import Field, model_validator

from mpmkit.contracts import Space, Surface, quantity
from mpmkit.geometry import AnyMotion, MovingSolid, Solid

LARGEST = 1e9
"""Largest number of a surface, in SI units; far larger ones lose the size of a cell to rounding."""


class RigidSurface(Surface):
    """The surface of a solid that moves as a rigid body."""

    motion: AnyMotion | None = Field(default=None, description="how it moves; default: it is at rest")
    appears: float | None = quantity(
        "s", "time from which it is there; default: from the start", default=None
    )
    vanishes: float | None = quantity("s", "time from which it is gone; default: never", default=None)

    @model_validator(mode="after")
    def _appears_before_it_vanishes(self) -> RigidSurface:
        appears = 0.0 if self.appears is None else self.appears
        if self.vanishes is not None and self.vanishes <= appears:
            raise ValueError(
                f"vanishes is {self.vanishes:g} s; it must be above {appears:g} s, when the wall appears"
            )
        return self

    def problem(self, space: Space) -> str | None:
        for field, number in _numbers(self.model_dump(mode="json")):
            if abs(number) > LARGEST:
                return f"{field} is {number:g}; it must be between {-LARGEST:g} and {LARGEST:g}"
        found = None if self.motion is None else self.motion.problem(space)
        return None if found is None else f"the motion's {found}"

    def moving(self, solid: Solid, space: Space, thickness: float = math.inf) -> MovingSolid:
        """The solid in its motion, for the time in which it is there."""
        return MovingSolid(solid, self.motion, self.appears, self.vanishes, thickness, space.radial)


def _numbers(value: Any, field: str = "") -> Iterator[tuple[str, float]]:
    """All numbers of a part of a surface, with their places in it."""
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _numbers(part, f"{field}.{key}" if field else str(key))
    elif isinstance(value, int | float):
        yield field, value
