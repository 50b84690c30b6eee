"""Measured curves: columns of a CSV file."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..case.synonyms import nearest
from ..errors import CaseError
from .model import Measurement


@dataclass(frozen=True)
class Curve:
    """Times, s, values and standard uncertainties of a curve, all ``(n,)``."""

    time: np.ndarray
    value: np.ndarray
    uncertainty: np.ndarray


def read_curve(where: str, measurement: Measurement, unit: str) -> Curve:
    """Read the file of a measurement; lines that begin with # are comments.

    Args:
        where: place of the measurement in the fit file, for error messages.
        measurement: it must have a file.
        unit: of its variable; the default name of the column ends with it.

    Raises:
        CaseError: the file cannot be read, lacks a column, or has a cell that is not a number.
    """
    assert measurement.file is not None
    path = Path(measurement.file)
    try:
        with path.open(encoding="utf-8-sig", newline="") as lines:
            reader = csv.DictReader(line for line in lines if not line.startswith("#"))
            rows, headings = [dict(row) for row in reader], [str(name) for name in reader.fieldnames or ()]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or "it is not a CSV file in UTF-8"
        raise CaseError(f"{where}.file: '{path}' cannot be read: {reason}") from None
    twice = [name for number, name in enumerate(headings) if name in headings[:number]]
    if twice:
        raise CaseError(f"{where}.file: '{path}' has two columns '{twice[0]}'; rename one of them")
    for number, cells in enumerate(rows, start=1):
        more = cells.get(None)  # the cells beyond the headings
        if more:
            raise CaseError(
                f"{where}.file: '{path}', row {number} has {len(headings) + len(more)} cells, and there "
                f"are {len(headings)} columns; decimals are written with a point"
            )
    columns = measurement.columns
    value = columns.value or f"{measurement.variable}_{unit}"
    time = _column(where, path, rows, headings, "time", columns.time)
    values = _column(where, path, rows, headings, "value", value)
    if columns.uncertainty is not None:
        uncertainty = _column(where, path, rows, headings, "uncertainty", columns.uncertainty)
    elif measurement.uncertainty is not None:
        uncertainty = np.full(len(values), measurement.uncertainty)
    else:
        assert measurement.relative_uncertainty is not None
        uncertainty = measurement.relative_uncertainty * np.abs(values)
    if np.any(np.diff(time) <= 0):
        row = int(np.argmax(np.diff(time) <= 0)) + 2
        raise CaseError(f"{where}.file: '{path}', row {row}: the time must grow from row to row")
    kept = (time >= measurement.first) & (time <= (measurement.last or math.inf))
    if not kept.any():
        raise CaseError(f"{where}: '{path}' has no row from first to last")
    if np.any(uncertainty[kept] <= 0):
        row = int(np.flatnonzero(kept & (uncertainty <= 0))[0]) + 1
        raise CaseError(
            f"{where}.file: '{path}', row {row}: the uncertainty is {uncertainty[row - 1]:g}; it must be "
            "above 0"
        )
    return Curve(time[kept], values[kept], uncertainty[kept])


def _column(where: str, path: Path, rows: list, headings: list[str], role: str, name: str) -> np.ndarray:
    if name not in headings:
        meant = nearest(name, headings)
        hint = f"; did you mean '{meant}'?" if meant else ""
        raise CaseError(
            f"{where}.columns.{role}: '{path}' has no column '{name}'; its columns are "
            f"{', '.join(headings) or 'none'}{hint}"
        )
    if not rows:
        raise CaseError(f"{where}.file: '{path}' has no row of numbers")
    found = np.empty(len(rows))
    for number, row in enumerate(rows, start=1):
        try:
            found[number - 1] = float(row[name])
            if not math.isfinite(found[number - 1]):
                raise ValueError
        except (TypeError, ValueError):
            given = "missing" if row[name] is None else f"'{row[name]}'"
            raise CaseError(
                f"{where}.file: '{path}', row {number}: {name} is {given}; it must be a finite number"
            ) from None
    return found
