"""The quantities that can be measured, and their values from a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray

from ..output.summary import T500_DIAMETER
from ..running.recorder import COLUMNS, wall_columns
from ..study.quantities import FIGURES as OF_A_SUMMARY

FIGURES = {name: OF_A_SUMMARY[name] for name in OF_A_SUMMARY if name not in ("particles", "simulated_time")}
"""Results of a summary that can be measured: unit and meaning."""
HISTORIES = {column.name: (column.units, column.long_name) for column in COLUMNS} | {
    column.name: (column.units, column.long_name) for column in wall_columns(("r", "z"))
}
"""Variables of a history that can be measured: unit and meaning."""
TIMES = ("t500", "t500_from_lift")
"""Results that are times at which the spread reaches 500 mm."""
LENGTHS = {"spread_diameter", "final_spread", "slump", "final_slump", "height", "final_height", "axis_height"}
"""Results that are lengths of the material."""


SLOWEST = 10.0
"""Largest change of a time per relative change of the model's lengths, in run times."""


@dataclass(frozen=True)
class Quantity:
    """One measured quantity: a result, a history at given times, or the time when it reaches a level."""

    variable: str
    times: tuple[float, ...] | None = None
    """s, of a history"""
    reaches: float | None = None
    of: tuple[tuple[str, str], ...] = ()

    @property
    def is_time(self) -> bool:
        """Whether its value is a time at which something is reached."""
        return self.reaches is not None or self.variable in TIMES

    @property
    def unit(self) -> str:
        if self.is_time:
            return "s"
        return (FIGURES.get(self.variable) or HISTORIES[self.variable])[0]

    @property
    def words(self) -> str:
        """Its name in sentences."""
        if self.variable in TIMES:
            return "T500" if self.variable == "t500" else "T500 from the lift"
        if self.variable in FIGURES:
            return self.variable.replace("_", " ")
        name = {"spread_diameter": "spread", "height": "largest height"}.get(
            self.variable, self.variable.replace("_", " ")
        )
        if self.reaches is not None:
            return f"time at which the {name} reaches {self.reaches:g} {HISTORIES[self.variable][0]}"
        if self.times is not None and len(self.times) == 1:
            return f"{name} at {self.times[0]:.3g} s"
        return f"{name} over time"

    def of_run(self, summary: Mapping[str, Any], history: xarray.Dataset) -> tuple[np.ndarray, np.ndarray]:
        """Values from a run, and the change of each per relative change of the model's lengths.

        This change is |y| for a length, a force or a torque, and level/|rate| for a time, with the rate of
        the history when it reaches the level. So an error of 1 % in the spread becomes an error in T500.
        A level that is never reached gives a time after the end of the run, the later the farther the history
        is from the level. This time is not a result, but it leads a search in the right direction.
        """
        if self.is_time:
            variable = "spread_diameter" if self.variable in TIMES else self.variable
            level = T500_DIAMETER if self.variable in TIMES else self.reaches
            assert level is not None
            series = self._series(history, variable)
            time, scale = crossing(history.time.values, series, level)
            if self.variable in TIMES and summary.get(self.variable) is not None:
                time = float(summary[self.variable])
            return np.array([time]), np.array([scale])
        if self.times is None:
            value = summary.get(self.variable)
            value = math.nan if value is None else float(value)
            return np.array([value]), np.array([abs(value)])
        values = np.interp(self.times, history.time.values, self._series(history, self.variable))
        return values, np.abs(values)

    def _series(self, history: xarray.Dataset, variable: str) -> np.ndarray:
        return history[variable].sel(dict(self.of)).values


def crossing(time: np.ndarray, series: np.ndarray, level: float) -> tuple[float, float]:
    """When a series first reaches a level, s, and level/|rate| there."""
    above = series >= level if series[0] < level else series <= level
    span = abs(level) or 1.0
    if not above.any():
        missing = float(np.abs(series - level).min()) / span
        return float(time[-1]) * (1 + missing), float(time[-1])
    after = int(np.argmax(above))
    if after == 0:
        return float(time[0]), 0.0
    before = after - 1
    change = series[after] - series[before]
    part = (level - series[before]) / change
    wide = slice(max(0, before - 4), after + 5)  # a rate over some rows is less noisy than over two
    rate = abs(float(np.polyfit(time[wide], series[wide], 1)[0]))
    return float(time[before] + part * (time[after] - time[before])), min(
        span / rate, SLOWEST * time[-1]
    ) if rate > 0 else SLOWEST * float(time[-1])
