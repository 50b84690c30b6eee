"""The measurements of a test, as one row of numbers, and the same numbers from a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray

from ..case.model import Case
from ..case.synonyms import nearest
from ..errors import CaseError
from .curves import read_curve
from .model import Measurement, Test
from .quantities import FIGURES, HISTORIES, Quantity

CORRELATION = 0.5
"""Correlation time of the model's error, relative to the duration of a curve."""


@dataclass(frozen=True)
class Measured:
    """One measurement: a quantity with its values and standard uncertainties, ``(n,)``."""

    where: str
    """its place in the fit file"""
    quantity: Quantity
    value: np.ndarray
    uncertainty: np.ndarray

    @property
    def time(self) -> np.ndarray:
        """s; NaN if it has no time."""
        return np.array(self.quantity.times if self.quantity.times is not None else (math.nan,))

    @property
    def is_curve(self) -> bool:
        return len(self.value) > 1

    def correlation(self) -> np.ndarray:
        """Correlation of the model's error, ``(n, n)``: exp(−|Δt|/T), T half of the curve's duration."""
        if not self.is_curve:
            return np.ones((1, 1))
        time = self.time
        return np.exp(-np.abs(time[:, None] - time) / (CORRELATION * (time[-1] - time[0])))


@dataclass(frozen=True)
class Predicted:
    """Predicted values of the rows of all tests, ``(m,)``, and the scales of their errors."""

    value: np.ndarray
    scale: np.ndarray


def measured_in(name: str, test: Test) -> list[Measured]:
    """The measurements of a test.

    Raises:
        CaseError: a variable does not exist, or a file is not valid.
    """
    return [
        _measured(f"tests.{name}.measurements.{number}", measurement)
        for number, measurement in enumerate(test.measurements)
    ]


def _measured(where: str, measurement: Measurement) -> Measured:
    variable, of = measurement.variable, tuple(sorted(measurement.of.items()))
    if variable not in FIGURES and variable not in HISTORIES:
        known = [*FIGURES, *HISTORIES]
        meant = nearest(variable, known)
        hint = f"; did you mean '{meant}'?" if meant else ""
        raise CaseError(f"{where}.variable is '{variable}'; it must be one of {', '.join(known)}{hint}")
    history = variable in HISTORIES
    timed = measurement.time is not None or measurement.reaches is not None
    if measurement.file is not None:
        if not history:
            raise CaseError(f"{where}: {variable} is one number per run; it cannot have a curve in a file")
        curve = read_curve(where, measurement, HISTORIES[variable][0])
        return Measured(where, Quantity(variable, tuple(curve.time), of=of), curve.value, curve.uncertainty)
    if history != timed:
        raise CaseError(
            f"{where}: {variable} is a history; give the time at which it was measured, or the level that it "
            "reaches"
            if history
            else f"{where}: {variable} is one number per run; leave out time and reaches"
        )
    value = measurement.value
    assert value is not None
    times = None if measurement.time is None else (measurement.time,)
    uncertainty = measurement.uncertainty or (measurement.relative_uncertainty or 0.0) * abs(value)
    if uncertainty <= 0:
        raise CaseError(f"{where}: a relative uncertainty of the value 0 is 0; give uncertainty instead")
    return Measured(
        where, Quantity(variable, times, measurement.reaches, of), np.array([value]), np.array([uncertainty])
    )


def predicted(measured: list[Measured], summary: Mapping[str, Any], history: xarray.Dataset) -> Predicted:
    """Predicted values of one run for the measurements of its test.

    Raises:
        CaseError: the run has no such variable, wall or component.
    """
    found = []
    for one in measured:
        try:
            found.append(one.quantity.of_run(summary, history))
        except (KeyError, ValueError):
            dimensions = (
                [str(d) for d in history[one.quantity.variable].dims]
                if (one.quantity.variable in history)
                else []
            )
            choices = "; ".join(
                f"{d} is one of {', '.join(map(str, history[d].values))}" for d in dimensions if d != "time"
            )
            raise CaseError(
                f"{one.where}: the case gives no {one.quantity.variable} of "
                f"{dict(one.quantity.of) or 'the whole scene'}{': ' if choices else ''}{choices}"
            ) from None
    return Predicted(np.concatenate([y for y, _ in found]), np.concatenate([s for _, s in found]))


def last_time(case: Case, measured: list[Measured]) -> float:
    """End of the runs of a test, s: the end of its case, or the last row if all measurements have times."""
    if any(one.quantity.times is None for one in measured):
        return case.end
    return min(case.end, max(float(one.time[-1]) for one in measured))
