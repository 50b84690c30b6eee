"""A rate that is constant or given by a table in time."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator

from .base import quantity
from .table import require_table


class RateTable(BaseModel):
    """Values at given times, linear between them, and constant before the first and after the last."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    times: list[float] = quantity("s", "rising times", min_length=2)
    values: list[Annotated[float, Field(ge=0)]] = quantity("1", "the value at each time", min_length=2)

    @model_validator(mode="after")
    def _is_a_table(self) -> RateTable:
        require_table("values", self.values, self.times)
        return self


def _tag(value: Any) -> str:
    # Tags differ from all names of keys, so that the path of an error is clear.
    return "by-table" if isinstance(value, dict | RateTable) else "constant"


Rate = Annotated[
    Annotated[Annotated[float, Field(gt=0)], Tag("constant")] | Annotated[RateTable, Tag("by-table")],
    Discriminator(_tag),
]
"""A rate in a case file: a number, or ``{"times": […], "values": […]}``."""


def integral(rate: float | RateTable, t0: float, t1: float) -> float:
    """∫ rate dt from t0 to t1 ≥ t0, exactly."""
    if not isinstance(rate, RateTable):
        return rate * (t1 - t0)
    inner = [t for t in rate.times if t0 < t < t1]
    times = np.array([t0, *inner, t1])
    values = np.interp(times, rate.times, rate.values)
    return float(np.sum(np.diff(times) * (values[1:] + values[:-1]) / 2))


def largest(rate: float | RateTable, t0: float, t1: float) -> float:
    """Largest value of the rate between two times."""
    if not isinstance(rate, RateTable):
        return rate
    inner = [v for t, v in zip(rate.times, rate.values, strict=True) if t0 < t < t1]
    return float(max([*inner, *np.interp([t0, t1], rate.times, rate.values)]))
