"""A stream that is poured from a height."""

from __future__ import annotations

import math

import numpy as np

from mpmkit.contracts import Mouth, Source, Space, hookimpl, quantity


class Pour(Source):
    """A round stream (in plane strain a flat one) that falls from a mouth, at a given rate.

    s = rate (t - start) / (ρ A), until a given mass is in.
    """

    name = "pour"
    api_version = 2
    citation = "none: a definition"

    centre: list[float] = quantity(
        "m", "middle of the mouth; [0, z] in axisymmetric", min_length=2, max_length=3
    )
    radius: float = quantity("m", "radius of the stream, or half its width in plane strain", gt=0)
    rate: float = quantity("kg/s", "mass per time; in 3d of the part that is simulated", gt=0)
    mass: float | None = quantity("kg", "mass after which it ends; default: never", default=None, gt=0)
    start: float = quantity("s", "time at which it begins", default=0.0, ge=0)

    def problem(self, space: Space, domain: tuple[np.ndarray, np.ndarray]) -> str | None:
        if len(self.centre) != space.dim:
            needs = f"the space {space.name} needs {space.dim} numbers ({', '.join(space.axes)})"
            return f"centre is {self.centre}; {needs}"
        if space.radial and self.centre[0] != 0:
            return f"centre is {self.centre}; in the space axisymmetric a stream is on the axis, [0, z]"
        return None

    def mouth(self, space: Space, domain: tuple[np.ndarray, np.ndarray]) -> Mouth:
        centre, half = list(self.centre), [self.radius] * (space.dim - 1) + [0.0]
        if space.radial:
            centre[0] = half[0] = self.radius / 2
        return Mouth(tuple(centre), tuple(half), space.dim - 1, -1, round=space.dim == 3)

    def pushed(self, t: float, area: float, density: float) -> float:
        begins, ends = self.spell(area, density)
        return self.rate / (density * area) * max(0.0, min(t, ends) - begins)

    def fastest(self, t0: float, t1: float, area: float, density: float) -> float:
        return self.rate / (density * area)

    def spell(self, area: float, density: float) -> tuple[float, float]:
        return self.start, math.inf if self.mass is None else self.start + self.mass / self.rate


@hookimpl
def mpmkit_sources() -> list[type[Source]]:
    return [Pour]
