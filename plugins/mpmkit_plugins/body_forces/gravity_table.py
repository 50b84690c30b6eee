"""Gravity by a table in time."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from mpmkit.contracts import BodyForce, Space, hookimpl, quantity, require_table

from .vectors import wrong_length


class GravityTable(BodyForce):
    """Gravity by a table in time: linear between the times, constant before the first and after the last.

    This is gravity relative to a plane that is tilted slowly.
    """

    name = "gravity-table"
    api_version = 2
    citation = "none: a definition"
    uniform = is_gravity = True

    times: list[float] = quantity("s", "rising times", min_length=2)
    vectors: list[Annotated[list[float], Field(min_length=2, max_length=3)]] = quantity(
        "m/s^2", "acceleration along each axis at each of the times", min_length=2
    )

    @model_validator(mode="after")
    def _is_a_table(self) -> GravityTable:
        require_table("vectors", self.vectors, self.times)
        return self

    def problem(self, space: Space) -> str | None:
        said = (wrong_length(f"vectors.{row}", vector, space) for row, vector in enumerate(self.vectors))
        return next(filter(None, said), None)

    def acceleration(self, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
        return np.tile(self._at(np.array([t])), (len(x), 1))

    def mean_acceleration(self, x: np.ndarray, v: np.ndarray, t0: float, t1: float) -> np.ndarray:
        """The trapezoidal rule with the times of the table in between is exact."""
        t = np.array([t0, *(time for time in self.times if t0 < time < t1), t1])
        a = self._at(t)
        change = (np.diff(t)[:, None] * (a[1:] + a[:-1]) / 2).sum(axis=0)
        return np.tile(change / (t1 - t0), (len(x), 1))

    def _at(self, t: np.ndarray) -> np.ndarray:
        """m/s², (m, dim), at times, s."""
        along = zip(*self.vectors, strict=True)
        return np.column_stack([np.interp(t, self.times, component) for component in along])

    def largest(self, lower: np.ndarray, upper: np.ndarray, t0: float, t1: float) -> np.ndarray:
        return np.abs(self.vectors).max(axis=0)

    def settles(self) -> float:
        return self.times[-1]


@hookimpl
def mpmkit_body_forces() -> list[type[BodyForce]]:
    return [GravityTable]
