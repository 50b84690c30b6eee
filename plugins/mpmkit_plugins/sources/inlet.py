"""An inlet: a section at rest through which material comes in."""

from __future__ import annotations

import math

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import Mouth, Rate, Source, Space, hookimpl, quantity
from mpmkit.contracts.rate import integral, largest


class Inlet(Source):
    """A whole face of the grid, a rectangle, or a disc in 3-D, with a given velocity or flux.

    s = ∫ v dt from ``start`` to ``end``, with v = ``velocity`` or ``flux``/area.
    """

    name = "inlet"
    api_version = 2
    citation = "none: a definition"

    face: str | None = quantity("1", "face of the grid that is the section, such as x_min", default=None)
    lower: list[float] | None = quantity(
        "m", "lower corner of the section", default=None, min_length=2, max_length=3
    )
    upper: list[float] | None = quantity(
        "m",
        "upper corner; it equals the lower one along the normal",
        default=None,
        min_length=2,
        max_length=3,
    )
    centre: list[float] | None = quantity(
        "m", "middle of a disc, only in 3d", default=None, min_length=3, max_length=3
    )
    radius: float | None = quantity("m", "radius of a disc, only in 3d", default=None, gt=0)
    direction: str | None = quantity(
        "1", "axis along which material comes in, such as x or -z; not for a face", default=None
    )
    velocity: Rate | None = quantity("m/s", "velocity, or a table of it in time", default=None)
    flux: Rate | None = quantity("m^3/s", "volume per time, or a table of it", default=None)
    start: float = quantity("s", "time at which it begins", default=0.0, ge=0)
    end: float | None = quantity("s", "time at which it ends; default: never", default=None)

    @model_validator(mode="after")
    def _is_whole(self) -> Inlet:
        if (self.velocity is None) == (self.flux is None):
            have = "no velocity and no flux" if self.flux is None else "velocity and flux"
            raise ValueError(f"it has {have}; it must have one of them")
        sections = [
            self.face is not None,
            self.lower is not None or self.upper is not None,
            self.centre is not None or self.radius is not None,
        ]
        if sum(sections) != 1:
            raise ValueError(
                "its section must be given by one of: face; lower, upper and direction; centre, radius and "
                "direction"
            )
        if (self.lower is None) != (self.upper is None):
            raise ValueError("lower and upper must be given together")
        if (self.centre is None) != (self.radius is None):
            raise ValueError("centre and radius must be given together")
        if (self.face is None) == (self.direction is None):
            raise ValueError(
                "direction is missing; it must be an axis, such as 'x' or '-z'"
                if self.face is None
                else "direction is given, but a face lets material in along its own normal; leave it out"
            )
        if self.end is not None and self.end <= self.start:
            raise ValueError(f"end is {self.end:g} s; it must be above start, {self.start:g} s")
        return self

    def problem(self, space: Space, domain: tuple[np.ndarray, np.ndarray]) -> str | None:
        if self.face is not None:
            allowed = [name for name in space.faces if not (space.radial and name.startswith("r"))]
            return (
                None
                if self.face in allowed
                else f"face is '{self.face}'; it must be one of {', '.join(allowed)}"
            )
        axes = [axis for axis in space.axes if axis != "r"]
        allowed = [sign + axis for axis in axes for sign in ("", "-")]
        if self.direction not in allowed:
            return f"direction is '{self.direction}'; it must be one of {', '.join(allowed)}"
        if self.centre is not None:
            return None if space.dim == 3 else f"centre is {self.centre}, but only the space 3d has discs"
        assert self.lower is not None
        assert self.upper is not None
        for field, corner in (("lower", self.lower), ("upper", self.upper)):
            if len(corner) != space.dim:
                needs = f"the space {space.name} needs {space.dim} numbers ({', '.join(space.axes)})"
                return f"{field} is {corner}; {needs}"
        axis = space.axes.index(self.direction[-1])
        for a, name in enumerate(space.axes):
            low, high = self.lower[a], self.upper[a]
            if a == axis and low != high:
                return f"lower is {low:g} and upper {high:g} along {name}, the direction; they must be equal"
            if a != axis and not low < high:
                return f"lower is {low:g} and upper {high:g} along {name}; lower must be below upper"
        return None

    def mouth(self, space: Space, domain: tuple[np.ndarray, np.ndarray]) -> Mouth:
        if self.centre is not None:
            axis, sign = _direction(self.direction, space)
            half = np.full(3, self.radius)
            half[axis] = 0.0
            return Mouth(tuple(self.centre), tuple(half), axis, sign, round=True)
        if self.face is not None:
            letter, _, side = self.face.partition("_")
            axis, sign = space.axes.index(letter), 1 if side == "min" else -1
            lower, upper = (corner.astype(float) for corner in domain)
            lower[axis] = upper[axis] = lower[axis] if side == "min" else upper[axis]
        else:
            axis, sign = _direction(self.direction, space)
            lower, upper = np.array(self.lower, dtype=float), np.array(self.upper, dtype=float)
        return Mouth(tuple((lower + upper) / 2), tuple((upper - lower) / 2), axis, sign)

    def pushed(self, t: float, area: float, density: float) -> float:
        t = min(t, math.inf if self.end is None else self.end)
        if t <= self.start:
            return 0.0
        if self.velocity is not None:
            return integral(self.velocity, self.start, t)
        assert self.flux is not None
        return integral(self.flux, self.start, t) / area

    def fastest(self, t0: float, t1: float, area: float, density: float) -> float:
        if self.velocity is not None:
            return largest(self.velocity, t0, t1)
        assert self.flux is not None
        return largest(self.flux, t0, t1) / area

    def spell(self, area: float, density: float) -> tuple[float, float]:
        return self.start, math.inf if self.end is None else self.end


def _direction(direction: str | None, space: Space) -> tuple[int, int]:
    """Axis and sign of a direction such as -z."""
    assert direction is not None
    return space.axes.index(direction[-1]), -1 if direction.startswith("-") else 1


@hookimpl
def mpmkit_sources() -> list[type[Source]]:
    return [Inlet]
