"""A scene in a vibrated mould."""

from __future__ import annotations

import math

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import BodyForce, Space, hookimpl, quantity

from .vectors import wrong_length


class Oscillation(BodyForce):
    """The grid, its faces and walls oscillate as a whole, by u; the material feels -d²u/dt².

    u = amplitude (sin(2π f (t - start) + phase) - sin(phase)), from start to end, as for the motion of a
    wall. With the default phase of π/2 the mould starts without a kick. It also ends without one, if it
    oscillates for a whole number of half periods. With any other phase, a start or an end at the speed w
    gives the impulse that stops or starts the mould at once.
    """

    name = "oscillation"
    api_version = 2
    citation = "Landau & Lifshitz, Mechanics, 3rd ed., Butterworth-Heinemann (1976), section 39"
    uniform = True

    amplitude: list[float] = quantity(
        "m", "amplitude of the mould along each axis", min_length=2, max_length=3
    )
    frequency: float = quantity("Hz", "frequency f", gt=0)
    phase: float = quantity("rad", "phase at the start; default: π/2", default=math.pi / 2)
    start: float = quantity("s", "time at which it begins; default: 0", default=0.0)
    end: float | None = quantity("s", "time at which it ends; default: never", default=None)

    @model_validator(mode="after")
    def _ends_after_its_start(self) -> Oscillation:
        if self.end is not None and self.end <= self.start:
            raise ValueError(f"end is {self.end:g} s; it must be above start, {self.start:g} s")
        return self

    def problem(self, space: Space) -> str | None:
        return wrong_length("amplitude", self.amplitude, space)

    def acceleration(self, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
        size = self._rate**2 * math.sin(self._angle(t)) if self._moves(t) else 0.0
        return np.tile(size * np.array(self.amplitude), (len(x), 1))

    def mean_acceleration(self, x: np.ndarray, v: np.ndarray, t0: float, t1: float) -> np.ndarray:
        size = (self._velocity(t0) - self._velocity(t1)) / (t1 - t0)
        return np.tile(size * np.array(self.amplitude), (len(x), 1))

    @property
    def _rate(self) -> float:
        """2π f, rad/s."""
        return 2 * math.pi * self.frequency

    def _angle(self, t: float) -> float:
        return self._rate * (t - self.start) + self.phase

    def _velocity(self, t: float) -> float:
        """Velocity of the mould over its amplitude, 1/s."""
        return self._rate * math.cos(self._angle(t)) if self._moves(t) else 0.0

    def _moves(self, t: float) -> bool:
        return self.start <= t < self.settles()

    def largest(self, lower: np.ndarray, upper: np.ndarray, t0: float, t1: float) -> np.ndarray:
        return self._rate**2 * np.abs(self.amplitude)

    def settles(self) -> float:
        return math.inf if self.end is None else self.end

    def shortest_period(self) -> float:
        return 1 / self.frequency


@hookimpl
def mpmkit_body_forces() -> list[type[BodyForce]]:
    return [Oscillation]
