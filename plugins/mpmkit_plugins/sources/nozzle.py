"""A nozzle that moves along a path and lays a filament."""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from mpmkit.contracts import Mouth, Source, Space, hookimpl, quantity

from .gcode import Course, course_of


class Nozzle(Source):
    """A mouth that moves from point to point, and pushes material downwards.

    The path is a table of points with a speed and a flux for each way between two of them, or G-code.
    """

    name = "nozzle"
    api_version = 2
    citation = "G-code: ISO 6983-1:2009"

    radius: float = quantity("m", "radius of the mouth, or half its width in plane strain", gt=0)
    points: list[Annotated[list[float], Field(min_length=2, max_length=3)]] | None = quantity(
        "m", "places of the middle of the mouth, in order", default=None, min_length=2
    )
    speeds: list[Annotated[float, Field(gt=0)]] | None = quantity(
        "m/s", "speed from each point to the next", default=None
    )
    fluxes: list[Annotated[float, Field(ge=0)]] | None = quantity(
        "m^3/s", "volume per time from each point to the next", default=None
    )
    gcode: list[str] | None = quantity(
        "1", "lines with G0, G1, G90 and G92: X, Y, Z and E in mm, F in mm/min", default=None, min_length=1
    )
    filament_diameter: float | None = quantity(
        "m", "diameter of the filament whose length is E; default: E is a volume in mm³", default=None, gt=0
    )
    start: float = quantity("s", "time at which it begins", default=0.0, ge=0)

    @model_validator(mode="after")
    def _has_a_path(self) -> Nozzle:
        if (self.points is None) == (self.gcode is None):
            have = "no points and no gcode" if self.gcode is None else "points and gcode"
            raise ValueError(f"it has {have}; it must have one of them")
        if self.points is not None:
            ways = len(self.points) - 1
            for field, values in (("speeds", self.speeds), ("fluxes", self.fluxes)):
                if values is None or len(values) != ways:
                    count = 0 if values is None else len(values)
                    raise ValueError(
                        f"{field} has {count} entries; {ways + 1} points have {ways} moves between them"
                    )
            if len({len(point) for point in self.points}) > 1:
                raise ValueError("points must all have the same number of coordinates")
            for number, (one, other) in enumerate(pairwise(self.points)):
                if one == other:
                    raise ValueError(f"points.{number} and points.{number + 1} are the same, {one}")
        elif self.speeds is not None or self.fluxes is not None:
            raise ValueError("speeds and fluxes are those between points; gcode has F and E instead")
        if not self._course.volumes[-1] > 0:
            raise ValueError("its path brings in no material: no flux, or no E, is above 0")
        return self

    @cached_property
    def _course(self) -> Course:
        """Times from the start, places and volumes at the corners of the path."""
        if self.gcode is not None:
            section = 1e-9
            if self.filament_diameter is not None:
                section = 1e-3 * math.pi * self.filament_diameter**2 / 4
            return course_of(self.gcode, section)
        assert self.points is not None
        places = np.array(self.points, dtype=float)
        lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
        spent = lengths / np.array(self.speeds)
        times = np.concatenate([[0.0], np.cumsum(spent)])
        volumes = np.concatenate([[0.0], np.cumsum(spent * np.array(self.fluxes))])
        return Course(tuple(times.tolist()), tuple(map(tuple, places.tolist())), tuple(volumes.tolist()))

    def problem(self, space: Space, domain: tuple[np.ndarray, np.ndarray]) -> str | None:
        if space.radial:
            return "kind is 'nozzle', which the space axisymmetric does not have"
        if self.gcode is not None and space.dim != 3:
            return f"gcode has X, Y and Z, which the space {space.name} does not have; give points"
        if self.points is not None and len(self.points[0]) != space.dim:
            needs = f"the space {space.name} needs {space.dim} numbers ({', '.join(space.axes)})"
            return f"points.0 is {self.points[0]}; {needs}"
        return None

    def mouth(self, space: Space, domain: tuple[np.ndarray, np.ndarray]) -> Mouth:
        half = (self.radius,) * (space.dim - 1) + (0.0,)
        first = self._course.places[0]
        return Mouth(tuple(float(x) for x in first), half, space.dim - 1, -1, round=space.dim == 3)

    def moved(self, t: float) -> np.ndarray:
        course = self._course
        since = min(max(t - self.start, 0.0), course.times[-1])
        away = np.array(course.places) - course.places[0]
        return np.array([np.interp(since, course.times, along) for along in away.T])

    def pushed(self, t: float, area: float, density: float) -> float:
        course = self._course
        return float(np.interp(t - self.start, course.times, course.volumes)) / area

    def fastest(self, t0: float, t1: float, area: float, density: float) -> float:
        course = self._course
        spent = np.diff(course.times)
        moved = np.linalg.norm(np.diff(course.places, axis=0), axis=1) / spent
        speed = moved + np.diff(course.volumes) / area / spent
        times = np.array(course.times)
        within = (times[:-1] <= t1 - self.start) & (times[1:] >= t0 - self.start)
        return float(speed[within].max(initial=0.0))

    def spell(self, area: float, density: float) -> tuple[float, float]:
        return self.start, self.start + float(self._course.times[-1])


@hookimpl
def mpmkit_sources() -> list[type[Source]]:
    return [Nozzle]
