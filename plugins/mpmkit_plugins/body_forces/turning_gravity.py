"""Gravity that turns at a constant rate."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import BodyForce, Space, hookimpl, quantity
from mpmkit.geometry import axis_problem, generator, rotation

from .vectors import wrong_length


class TurningGravity(BodyForce):
    """Gravity that turns about an axis, g(t) = Q(rate (t - start)) vector, from start to end.

    Relative to an apparatus that is tilted, gravity turns in the opposite direction. In 3-D it turns by the
    right-hand rule about ``axis``. In plane strain a positive rate turns x towards z.
    """

    name = "turning-gravity"
    api_version = 2
    citation = "none: a definition"
    uniform = is_gravity = True

    vector: list[float] = quantity("m/s^2", "acceleration until the start", min_length=2, max_length=3)
    rate: float = quantity("rad/s", "angular velocity")
    axis: list[float] | None = quantity(
        "1", "direction of the axis, only in 3d", default=None, min_length=3, max_length=3
    )
    start: float = quantity("s", "time at which it begins to turn; default: 0", default=0.0)
    end: float | None = quantity("s", "time at which it ends; default: never", default=None)

    @model_validator(mode="after")
    def _ends_after_its_start(self) -> TurningGravity:
        if self.end is not None and self.end <= self.start:
            raise ValueError(f"end is {self.end:g} s; it must be above start, {self.start:g} s")
        return self

    def problem(self, space: Space) -> str | None:
        if space.radial:
            return f"the space {space.name} has no axis about which gravity could turn"
        return wrong_length("vector", self.vector, space) or axis_problem(self.axis, space.dim, space.name)

    def acceleration(self, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
        return np.tile(rotation(self.axis, self._angle(t)) @ np.array(self.vector), (len(x), 1))

    def mean_acceleration(self, x: np.ndarray, v: np.ndarray, t0: float, t1: float) -> np.ndarray:
        """The mean of a vector that turns from α - h to α + h is its part along the axis, and sin(h)/h of the
        rest, turned by α."""
        vector, K = np.array(self.vector), generator(self.axis)
        across = -K @ K @ vector
        change = np.zeros_like(vector)
        times = [t0, *(time for time in (self.start, self._end) if t0 < time < t1), t1]
        for before, after in pairwise(times):
            low, high = self._angle(before), self._angle(after)
            turned = rotation(self.axis, (low + high) / 2) @ across
            change += (after - before) * (vector - across + np.sinc((high - low) / (2 * np.pi)) * turned)
        return np.tile(change / (t1 - t0), (len(x), 1))

    @property
    def _end(self) -> float:
        return math.inf if self.end is None else self.end

    def _angle(self, t: float) -> float:
        """Angle turned by so far, rad."""
        return self.rate * max(0.0, min(t, self._end) - self.start)

    def largest(self, lower: np.ndarray, upper: np.ndarray, t0: float, t1: float) -> np.ndarray:
        """Component i is p + a cos(α) + b sin(α): largest at an end, or where α = atan2(b, a) + k π."""
        vector, K = np.array(self.vector), generator(self.axis)
        across = -K @ K @ vector
        first, last = sorted((self._angle(t0), self._angle(t1)))
        found = []
        for p, a, b in zip(vector - across, across, K @ across, strict=True):
            extreme = math.atan2(b, a)
            k = math.ceil((first - extreme) / math.pi)
            between = [extreme + n * math.pi for n in (k, k + 1) if extreme + n * math.pi <= last]
            angles = (first, last, *between)
            found.append(max(abs(p + a * math.cos(angle) + b * math.sin(angle)) for angle in angles))
        return np.array(found)

    def settles(self) -> float:
        return self._end if self.rate else -math.inf

    def shortest_period(self) -> float:
        return 2 * math.pi / abs(self.rate) if self.rate else math.inf


@hookimpl
def mpmkit_body_forces() -> list[type[BodyForce]]:
    return [TurningGravity]
