"""A scene on an apparatus that rotates, such as a centrifuge."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import BodyForce, Space, hookimpl, quantity, require_table
from mpmkit.geometry import axis_problem, generator

from .vectors import wrong_length


class RotatingFrame(BodyForce):
    """The grid, its faces and walls rotate as a whole with ω about an axis.

    The material feels a = -ω × (ω × r) - 2 ω × v - dω/dt × r: the centrifugal, the Coriolis and the Euler
    term, with r from ``point`` and v relative to the frame. In 3-D the frame turns by the right-hand rule
    about ``axis``; in plane strain the axis is out of the plane, and a positive rate turns x towards z.
    """

    name = "rotating-frame"
    api_version = 2
    citation = "Landau & Lifshitz, Mechanics, 3rd ed., Butterworth-Heinemann (1976), section 39"
    of_velocity = True

    point: list[float] = quantity("m", "a point of the axis", min_length=2, max_length=3)
    axis: list[float] | None = quantity(
        "1", "direction of the axis, only in 3d", default=None, min_length=3, max_length=3
    )
    rate: float | None = quantity("rad/s", "angular velocity ω, if it is constant", default=None)
    times: list[float] | None = quantity(
        "s", "rising times, if ω changes; it is linear between them", default=None, min_length=2
    )
    rates: list[float] | None = quantity("rad/s", "ω at each of the times", default=None, min_length=2)

    @model_validator(mode="after")
    def _has_one_rate(self) -> RotatingFrame:
        if (self.times is None) != (self.rates is None) or (self.rate is None) == (self.rates is None):
            raise ValueError("it must have either rate, or times and rates")
        if self.times is not None and self.rates is not None:
            require_table("rates", self.rates, self.times)
        return self

    def problem(self, space: Space) -> str | None:
        if space.radial:
            return (
                f"the space {space.name} has no velocity around its axis, which the Coriolis and the Euler "
                "term need; the kind 'centrifugal' leaves them out"
            )
        return wrong_length("point", self.point, space) or axis_problem(self.axis, space.dim, space.name)

    def acceleration(self, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
        return self._terms(x, v, self._omega(t), self._change(t))

    def mean_acceleration(self, x: np.ndarray, v: np.ndarray, t0: float, t1: float) -> np.ndarray:
        """With ω in the middle of the step and its mean change, so that the Euler term is exact."""
        change = (self._omega(t1) - self._omega(t0)) / (t1 - t0)
        return self._terms(x, v, self._omega((t0 + t1) / 2), change)

    def _terms(self, x: np.ndarray, v: np.ndarray, omega: float, change: float) -> np.ndarray:
        K = generator(self.axis)
        around = (x - np.array(self.point)) @ K.T  # axis × r
        return -(omega**2) * (around @ K.T) - 2 * omega * (v @ K.T) - change * around

    def _omega(self, t: float) -> float:
        """ω, rad/s."""
        if self.times is None or self.rates is None:
            return float(self.rate or 0.0)
        return float(np.interp(t, self.times, self.rates))

    def _change(self, t: float) -> float:
        """dω/dt, rad/s²."""
        if self.times is None or self.rates is None:
            return 0.0
        row = int(np.searchsorted(self.times, t, side="right")) - 1
        slopes = np.diff(self.rates) / np.diff(self.times)
        return float(slopes[row]) if 0 <= row < len(slopes) else 0.0

    def largest(self, lower: np.ndarray, upper: np.ndarray, t0: float, t1: float) -> np.ndarray:
        """Each term is linear in r, and so largest at a corner."""
        corners = np.array(list(product(*zip(lower, upper, strict=True))))
        fastest = abs(self.rate or 0.0) if self.rates is None else float(np.abs(self.rates).max())
        steepest = 0.0
        if self.times is not None and self.rates is not None:
            steepest = float(np.abs(np.diff(self.rates) / np.diff(self.times)).max())
        rest = np.zeros_like(corners)
        centrifugal, euler = self._terms(corners, rest, fastest, 0.0), self._terms(corners, rest, 0.0, 1.0)
        return (np.abs(centrifugal) + steepest * np.abs(euler)).max(axis=0)

    def settles(self) -> float:
        return -math.inf if self.times is None else self.times[-1]

    def shortest_period(self) -> float:
        """That of the circles which the Coriolis term makes, π/ω."""
        fastest = max(map(abs, self.rates or [self.rate or 0.0]))
        return math.pi / fastest if fastest else math.inf


@hookimpl
def mpmkit_body_forces() -> list[type[BodyForce]]:
    return [RotatingFrame]
