"""The measurements of a test, as one row of numbers, and the same numbers from a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray

from ..case.ending import Until
from ..case.model import Case
from ..case.synonyms import nearest
from ..errors import CaseError
from .curves import read_curve
from .model import Measurement, Test
from .quantities import FIGURES, HISTORIES, Quantity, check_part

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


def measured_in(name: str, test: Test, case: Case) -> list[Measured]:
    """The measurements of a test, with its case.

    Raises:
        CaseError: a variable does not exist, or a file is not valid.
    """
    return [
        _measured(f"tests.{name}.measurements.{number}", measurement, case)
        for number, measurement in enumerate(test.measurements)
    ]


def _measured(where: str, measurement: Measurement, case: Case) -> Measured:
    variable, of = measurement.variable, tuple(sorted(measurement.of.items()))
    own = {name: (entry.unit, entry.description) for name, entry in case.measurements.items()}
    if variable not in FIGURES and variable not in HISTORIES and variable not in own:
        known = [*FIGURES, *HISTORIES, *own]
        meant = nearest(variable, known)
        hint = f"; did you mean '{meant}'?" if meant else ""
        raise CaseError(f"{where}.variable is '{variable}'; it must be one of {', '.join(known)}{hint}")
    check_part(where, variable, measurement.of, case)
    unit = own[variable][0] if variable in own else (FIGURES.get(variable) or HISTORIES[variable])[0]
    history = variable in HISTORIES
    timed = measurement.time is not None or measurement.reaches is not None
    if measurement.file is not None:
        if variable in FIGURES:
            raise CaseError(f"{where}: {variable} is one number per run; it cannot have a curve in a file")
        curve = read_curve(where, measurement, unit)
        quantity = Quantity(variable, tuple(curve.time), of=of, own_unit=unit)
        return Measured(where, quantity, curve.value, curve.uncertainty)
    if history and not timed:
        raise CaseError(
            f"{where}: {variable} is a history; give the time at which it was measured, or the level that it "
            "reaches"
        )
    if variable in FIGURES and timed:
        raise CaseError(f"{where}: {variable} is one number per run; leave out time and reaches")
    value = measurement.value
    assert value is not None
    times = None if measurement.time is None else (measurement.time,)
    uncertainty = measurement.uncertainty or (measurement.relative_uncertainty or 0.0) * abs(value)
    if uncertainty <= 0:
        raise CaseError(f"{where}: a relative uncertainty of the value 0 is 0; give uncertainty instead")
    return Measured(
        where,
        Quantity(variable, times, measurement.reaches, of, unit),
        np.array([value]),
        np.array([uncertainty]),
    )


def predicted(
    measured: list[Measured], summary: Mapping[str, Any], history: xarray.Dataset, end: float
) -> Predicted:
    """Predicted values of one run for the measurements of its test; ``end``, s, is its latest end.

    Raises:
        CaseError: the run has no such value.
    """
    found = [one.quantity.of_run(summary, history, end) for one in measured]
    for one, (value, _) in zip(measured, found, strict=True):
        if not np.isfinite(value).all():
            raise CaseError(f"{one.where}: a run gave no {one.quantity.words}, so that it cannot be fitted")
    return Predicted(np.concatenate([y for y, _ in found]), np.concatenate([s for _, s in found]))


@dataclass(frozen=True)
class Bounds:
    """What a run says of the rows: values between ``low`` and ``high``, ``(m,)``.

    They are equal where the run gives a value. A run that material left before its end gives values up to
    then, and for later rows what cannot go back: a spread is at least the last one.
    """

    low: np.ndarray
    high: np.ndarray


def bounds_of_stopped(
    measured: list[Measured], summary: Mapping[str, Any], history: xarray.Dataset
) -> Bounds:
    """What a run says that ended because material left the domain."""
    found = [one.quantity.of_stopped_run(summary, history) for one in measured]
    return Bounds(np.concatenate([low for low, _ in found]), np.concatenate([high for _, high in found]))


def end_of(case: Case, measured: list[Measured]) -> dict[str, Any] | float:
    """End of the runs of a test: that of its case, or the last row if all measurements have times.

    A run also ends at rest, if its case does: a row after that is the same.
    """
    until = case.until.model_dump(mode="json") if isinstance(case.until, Until) else case.until
    if any(one.quantity.times is None for one in measured):
        return until
    last = min(case.end, max(float(one.time[-1]) for one in measured))
    return {"rest": True, "at_most": last} if isinstance(until, dict) and until["rest"] else last
