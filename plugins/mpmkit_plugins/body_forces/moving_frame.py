"""A scene in an apparatus that is moved, such as a drop table."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from mpmkit.contracts import BodyForce, Space, hookimpl, quantity, require_table

from .vectors import wrong_length


class MovingFrame(BodyForce):
    """The grid, its faces and walls move as a whole, with a velocity w by a table; the material feels -dw/dt.

    The velocity is linear between the times, and constant before the first and after the last. Lengths and
    velocities of the scene are relative to the frame. A sudden stop gives its whole impulse, also if it is
    shorter than a time step.
    """

    name = "moving-frame"
    api_version = 2
    citation = "Landau & Lifshitz, Mechanics, 3rd ed., Butterworth-Heinemann (1976), section 39"
    uniform = True

    times: list[float] = quantity("s", "rising times", min_length=2)
    velocities: list[Annotated[list[float], Field(min_length=2, max_length=3)]] = quantity(
        "m/s", "velocity w of the frame along each axis at each of the times", min_length=2
    )
    period: float | None = quantity("s", "the table is repeated after it; default: never", default=None, gt=0)
    count: float | None = quantity(
        "1",
        "number of passes through the table; default: until the end of the run",
        default=None,
        ge=1,
    )

    @model_validator(mode="after")
    def _is_a_table(self) -> MovingFrame:
        require_table("velocities", self.velocities, self.times)
        if self.period is None and self.count is not None:
            raise ValueError(
                f"count is {self.count:g}, but there is no period; give both, or leave out count"
            )
        if self.count is not None and not self.count.is_integer():
            raise ValueError(f"count is {self.count:g}; it must be a whole number")
        lasts = self.times[-1] - self.times[0]
        if self.period is not None and self.period < lasts:
            raise ValueError(f"period is {self.period:g} s; it must be at least the {lasts:g} s of the table")
        if self.period is not None and self.velocities[0] != self.velocities[-1]:
            raise ValueError(
                f"velocities begins with {self.velocities[0]} and ends with {self.velocities[-1]}; with a "
                "period both must be the same"
            )
        return self

    def problem(self, space: Space) -> str | None:
        said = (wrong_length(f"velocities.{row}", w, space) for row, w in enumerate(self.velocities))
        return next(filter(None, said), None)

    def acceleration(self, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
        row = int(np.searchsorted(self.times, self._within(t), side="right")) - 1
        moves = 0 <= row < len(self.times) - 1
        return np.tile(-self._slopes()[row] if moves else np.zeros(x.shape[1]), (len(x), 1))

    def mean_acceleration(self, x: np.ndarray, v: np.ndarray, t0: float, t1: float) -> np.ndarray:
        return np.tile((self._velocity(t0) - self._velocity(t1)) / (t1 - t0), (len(x), 1))

    def _within(self, t: float) -> float:
        """The time of the table, s, at a time of the run."""
        if self.period is None:
            return t
        passed = max(0, math.floor((t - self.times[0]) / self.period))
        return t - min(passed, (self.count or math.inf) - 1) * self.period

    def _velocity(self, t: float) -> np.ndarray:
        """w, m/s, (dim,)."""
        within = self._within(t)
        return np.array([np.interp(within, self.times, w) for w in zip(*self.velocities, strict=True)])

    def _slopes(self) -> np.ndarray:
        """dw/dt, m/s², (rows - 1, dim)."""
        return np.diff(np.array(self.velocities), axis=0) / np.diff(np.array(self.times))[:, None]

    def largest(self, lower: np.ndarray, upper: np.ndarray, t0: float, t1: float) -> np.ndarray:
        return np.abs(self._slopes()).max(axis=0)

    def settles(self) -> float:
        if self.period is None:
            return self.times[-1]
        return self.times[-1] + ((self.count or math.inf) - 1) * self.period


@hookimpl
def mpmkit_body_forces() -> list[type[BodyForce]]:
    return [MovingFrame]
