"""Error against cost: which member gives most for its time."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray

from ..errors import CaseError
from .collect import COSTS
from .figures import members

FINEST = "finest"
"""The member with the most particle-steps of those that finished, as the reference of the others."""


@dataclass(frozen=True)
class Point:
    """A member that finished."""

    title: str
    cost: float
    error: float


@dataclass(frozen=True)
class Chart:
    """All points, and what their error is against."""

    variable: str
    cost: str
    against: str
    points: list[Point]

    @property
    def front(self) -> list[Point]:
        """Pareto's front, cheapest first: nobody else is both cheaper and closer."""
        front: list[Point] = []
        for point in sorted(self.points, key=lambda point: (point.cost, point.error)):
            if not front or point.error < front[-1].error:
                front.append(point)
        return front


def chart(
    dataset: xarray.Dataset, variable: str, reference: str = FINEST, cost: str = "wall_seconds"
) -> Chart:
    """Errors and costs of the members that finished.

    The error of a history is its largest departure from the reference's, over the times that both have, as a
    part of the reference's largest value; that of a figure, such as ``t500``, is relative to it.

    Args:
        dataset: of ``collect``.
        variable: a history or a figure of the dataset.
        reference: a number, a CSV file with the columns ``time_s`` and ``<variable>_<unit>``, or ``finest``.
        cost: wall_seconds, cpu_seconds, steps, particle_steps or memory_bytes.

    Raises:
        CaseError: there is no such variable, cost or reference, or no member finished.
    """
    if variable not in dataset or dataset[variable].dtype.kind != "f":
        allowed = ", ".join(str(name) for name, field in dataset.data_vars.items() if field.dtype.kind == "f")
        raise CaseError(f"--variable {variable}: the study has no such variable; it has {allowed}")
    if cost not in COSTS:
        raise CaseError(f"--cost {cost}: it must be one of {', '.join(COSTS)}")
    finished = [
        (title, member) for title, member in members(dataset) if str(member.fate.item()) == "finished"
    ]
    if not finished:
        raise CaseError("no member of the study has finished")
    title, exact, against = "", None, reference
    if reference == FINEST:
        title, finest = max(finished, key=lambda item: float(item[1].particle_steps))
        exact, against = finest[variable], f"the finest member, {title}"
    elif (value := _number(reference)) is not None:
        exact, against = xarray.DataArray(value), f"{value:g}"
    else:
        exact, against = _from_file(Path(reference), variable), Path(reference).name
    points = [
        Point(name, float(member[cost]), _error(member[variable], exact))
        for name, member in finished
        if name != title
    ]
    return Chart(variable, cost, against, [point for point in points if math.isfinite(point.error)])


def _error(found: xarray.DataArray, exact: xarray.DataArray) -> float:
    if "time" not in found.dims:
        if exact.ndim:
            raise CaseError(
                f"--reference: '{found.name}' is one number a member, and so must its reference be"
            )
        return float(abs(found - exact) / abs(exact))
    if "time" not in exact.dims:
        found = found.dropna("time")[-1:]
        return (
            float(np.abs(found.values - exact.values).max() / abs(float(exact))) if len(found) else math.nan
        )
    at = exact.interp(time=found.time) if len(exact.time) != len(found.time) else exact
    departure = np.abs(found.values - at.values)
    return float(np.nanmax(departure) / np.nanmax(np.abs(at.values)))


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _from_file(path: Path, variable: str) -> xarray.DataArray:
    """A column of a CSV file, in SI units, whose lines that begin with # are remarks."""
    try:
        with path.open(encoding="utf-8") as lines:
            rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        column = next(name for name in rows[0] if name.startswith(variable))
        time, values = ([float(row[name]) for row in rows] for name in ("time_s", column))
    except OSError as error:
        raise CaseError(f"--reference {path}: it cannot be read: {error.strerror}") from None
    except (StopIteration, IndexError, KeyError, ValueError, UnicodeDecodeError):
        raise CaseError(
            f"--reference {path}: it must be a number, 'finest', or a CSV file with the columns time_s and "
            f"{variable}_<unit>, all of them numbers"
        ) from None
    return xarray.DataArray(values, {"time": time}, ("time",), name=variable)
