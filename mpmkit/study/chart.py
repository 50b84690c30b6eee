"""Error against cost: which member is the most accurate for its time."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray

from ..errors import CaseError
from .figures import members
from .quantities import COSTS

FINEST = "finest"
"""Name of the default reference: the finished member with the most particle-steps."""
ONE_PROBLEM = "one_problem"
"""Attribute of a study's dataset: 1 if all members solve the same problem, else 0."""


@dataclass(frozen=True)
class Point:
    """A member that finished."""

    title: str
    cost: float
    error: float


@dataclass(frozen=True)
class Chart:
    """All points, and the reference of their errors."""

    variable: str
    cost: str
    against: str
    points: list[Point]

    @property
    def front(self) -> list[Point]:
        """The Pareto front, cheapest first: no other member is both cheaper and more accurate."""
        front: list[Point] = []
        for point in sorted(self.points, key=lambda point: (point.cost, point.error)):
            if not front or point.error < front[-1].error:
                front.append(point)
        return front


def chart(
    dataset: xarray.Dataset, variable: str, reference: str = FINEST, cost: str = "wall_seconds"
) -> Chart:
    """Errors and costs of the members that finished.

    The error of a history is its largest difference from the reference over the common times, relative to the
    largest value of the reference. If the reference is a number, it is the error of the last value. The error
    of a result such as ``t500`` is relative to the reference.

    Args:
        dataset: of ``collect``.
        variable: a history or a figure of the dataset.
        reference: a number, ``finest``, or a CSV file with the columns ``time_s`` and ``<variable>_<unit>``,
            in the unit of the dataset.
        cost: wall_seconds, cpu_seconds, steps, particle_steps or memory_bytes.

    Raises:
        CaseError: there is no such variable, cost or reference, no member finished, or the finest member is
            no reference for the others because they solve other problems.
    """
    allowed = [str(name) for name, field in dataset.data_vars.items() if field.dtype.kind == "f"]
    if variable not in allowed:
        raise CaseError(f"--variable {variable}: the study has no such variable; it has {', '.join(allowed)}")
    if cost not in COSTS:
        raise CaseError(f"--cost {cost}: it must be one of {', '.join(COSTS)}")
    finished = [
        (title, member) for title, member in members(dataset) if str(member.fate.item()) == "finished"
    ]
    if not finished:
        raise CaseError("no member of the study has finished")
    title, exact, against = "", None, reference
    if reference == FINEST:
        if not dataset.attrs.get(ONE_PROBLEM, True):
            raise CaseError(
                "--reference finest: the members differ in their materials, bodies, boundaries or forces, so "
                "that a difference from the finest member is not an error; give a CSV file or a number as "
                "--reference"
            )
        title, finest = max(finished, key=lambda item: float(item[1].particle_steps))
        exact, against = finest[variable], f"the finest member, {title}"
    elif (value := _number(reference)) is not None:
        if not math.isfinite(value) or value == 0:
            raise CaseError(
                f"--reference {reference}: it must be finite and not 0, because errors are relative to it"
            )
        exact, against = xarray.DataArray(value), f"{value:g}"
    else:
        exact, against = _from_file(Path(reference), dataset[variable]), Path(reference).name
    points = [
        Point(name, float(member[cost]), _error(member[variable], exact))
        for name, member in finished
        if name != title
    ]
    points = [point for point in points if math.isfinite(point.error)]
    if not points:
        raise CaseError(f"no member that finished has a {variable} to compare with {against}")
    return Chart(variable, cost, against, points)


def _error(found: xarray.DataArray, exact: xarray.DataArray) -> float:
    """Relative error; NaN if the two cannot be compared."""
    if "time" not in found.dims and "time" in exact.dims:
        raise CaseError(f"--reference: '{found.name}' is one number per member; it must be a number too")
    if "time" not in exact.dims:
        known = found.values[np.isfinite(found.values)]  # for a history, use the last value
        values, at = (known[-1:], exact.values)
    else:
        at = np.interp(found.time, exact.time, exact.values, left=math.nan, right=math.nan)
        both = np.isfinite(found.values) & np.isfinite(at)
        values, at = found.values[both], at[both]
    largest = np.abs(at).max(initial=0.0)
    return float(np.abs(values - at).max() / largest) if len(values) and largest > 0 else math.nan


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _from_file(path: Path, variable: xarray.DataArray) -> xarray.DataArray:
    """A column of a CSV file, in SI units, whose lines that begin with # are remarks."""
    column = f"{variable.name}_{variable.attrs.get('units', '1')}"
    try:
        with path.open(encoding="utf-8") as lines:
            rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        time, values = (np.array([float(row[name]) for row in rows]) for name in ("time_s", column))
        if not len(rows) or not np.all(np.isfinite([time, values])) or np.any(np.diff(time) <= 0):
            raise ValueError
    except OSError as error:
        raise CaseError(f"--reference {path}: it cannot be read: {error.strerror}") from None
    except (KeyError, TypeError, ValueError, csv.Error):  # ValueError: of the encoding as well
        raise CaseError(
            f"--reference {path}: it must be a number, 'finest', or a CSV file with the columns time_s, "
            f"which grows from row to row, and {column}, all of them finite numbers"
        ) from None
    return xarray.DataArray(values, {"time": time}, ("time",), name=variable.name)
