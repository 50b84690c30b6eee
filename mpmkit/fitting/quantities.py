"""The quantities that can be measured, and their values from a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray

from ..case.model import Case
from ..errors import CaseError
from ..output.summary import T500_DIAMETER, trusted_rows
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
    own_unit: str = ""
    """unit of a measurement that the case defines"""

    @property
    def is_time(self) -> bool:
        """Whether its value is a time at which something is reached."""
        return self.reaches is not None or self.variable in TIMES

    @property
    def unit(self) -> str:
        if self.is_time:
            return "s"
        known = FIGURES.get(self.variable) or HISTORIES.get(self.variable)
        return self.own_unit if known is None else known[0]

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
            unit = HISTORIES[self.variable][0] if self.variable in HISTORIES else self.own_unit
            return f"time at which the {name} reaches {self.reaches:g} {unit}"
        if self.times is None:
            return name
        if len(self.times) == 1:
            return f"{name} at {self.times[0]:.3g} s"
        return f"{name} over time"

    def of_run(
        self, summary: Mapping[str, Any], history: xarray.Dataset, end: float | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Values from a run, and the change of each per relative change of the model's lengths.

        This change is |y| for a length, a force or a torque, and level/|rate| for a time, with the rate of
        the history when it reaches the level. So an error of 1 % in the spread becomes an error in T500.
        A level that is never reached gives a time after ``end``, s, the latest end of the run, the later the
        farther the history is from the level. This time is not a result, but it leads a search in the right
        direction.
        """
        if self.is_time:
            variable = "spread_diameter" if self.variable in TIMES else self.variable
            level = T500_DIAMETER if self.variable in TIMES else self.reaches
            assert level is not None
            series = self._series(history, variable)
            time, scale = crossing(history.time.values, series, level, end)
            if self.variable in TIMES and summary.get(self.variable) is not None:
                time = float(summary[self.variable])
            return np.array([time]), np.array([scale])
        if self.times is None:
            value = summary.get(self.variable)
            if value is None and self.variable == "at_rest_since":
                value = end  # it still moved
            value = math.nan if value is None else float(value)
            return np.array([value]), np.array([abs(value)])
        values = np.interp(self.times, history.time.values, self._series(history, self.variable))
        return values, np.abs(values)

    def of_stopped_run(
        self, summary: Mapping[str, Any], history: xarray.Dataset
    ) -> tuple[np.ndarray, np.ndarray]:
        """Least and largest values that agree with a run whose material left the domain at its last row.

        They are equal for values that the run had reached by then. Later, a spread only grows, and a level
        that was not reached is reached later.
        """
        history = trusted_rows(history, summary["stopped_because"])
        if self.is_time:
            if self.variable in TIMES and summary.get(self.variable) is None:
                return history.time.values[-1:], np.array([np.inf])
            (time,), _ = self.of_run(summary, history)
            end = history.time.values[-1]
            return np.array([min(time, end)]), np.array([time if time <= end else np.inf])
        if self.times is None:
            last = float(history.spread_diameter.values[-1])
            return np.array([last if self.variable == "final_spread" else -np.inf]), np.array([np.inf])
        series = self._series(history, self.variable)
        value = np.interp(self.times, history.time.values, series)
        reached = np.array(self.times) <= history.time.values[-1]
        least = value if self.variable == "spread_diameter" else -np.inf
        return np.where(reached, value, least), np.where(reached, value, np.inf)

    def _series(self, history: xarray.Dataset, variable: str) -> np.ndarray:
        series = history[variable].sel(dict(self.of)).values
        return series.reshape(len(series))  # a single wall or component need not be named


def crossing(
    time: np.ndarray, series: np.ndarray, level: float, end: float | None = None
) -> tuple[float, float]:
    """When a series first reaches a level, s, and level/|rate| there; never counts as after ``end``, s."""
    above = series >= level if series[0] < level else series <= level
    span = abs(level) or 1.0
    if not above.any():
        missing = float(np.abs(series - level).min()) / span
        end = float(time[-1]) if end is None else end
        return end * (1 + missing), end
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


def check_part(where: str, variable: str, of: Mapping[str, str], case: Case) -> None:
    """Refuse a part that the variable does not have, and a variable that the case does not have.

    Raises:
        CaseError: the sentence names the parts.
    """
    axes = case.space_.axes
    column = next((c for c in (*COLUMNS, *wall_columns(axes)) if c.name == variable), None)
    parts: dict[str, tuple[str, ...]] = {}
    if column is not None and column.of_walls:
        free = ("open", "periodic", "symmetry")
        faces = [name for name, kind in case.grid.faces.items() if kind not in free]
        parts["wall"] = (*case.walls, *faces)
        if not parts["wall"]:
            raise CaseError(f"{where}.variable is '{variable}', but the case has no walls")
    if column is not None and column.component:
        parts["component"] = tuple(axes)
    if column is not None and column.about:
        parts["about"] = tuple(column.about)
    if variable == "t500_from_lift" and not case.walls:
        raise CaseError(f"{where}.variable is 't500_from_lift', but the case has no mould that is lifted")
    for dimension, name in of.items():
        if dimension not in parts:
            known = (
                f"it may have {' and '.join(parts)}" if parts else f"{variable} has no parts; leave it out"
            )
            raise CaseError(f"{where}.of has the key '{dimension}'; {known}")
        if name not in parts[dimension]:
            raise CaseError(
                f"{where}.of.{dimension} is '{name}'; it must be one of {', '.join(parts[dimension])}"
            )
    for dimension, names in parts.items():
        if dimension not in of and len(names) > 1:
            raise CaseError(
                f"{where}: {variable} has a value for each {dimension}; give of.{dimension}, one of "
                f"{', '.join(names)}"
            )
