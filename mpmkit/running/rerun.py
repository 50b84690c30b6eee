"""Repeating a run from its directory, and comparing the results bit by bit."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..case.model import Case
from ..errors import CaseError
from ..output import RunDirectory
from ..output.netcdf import read_dataset
from ..output.summary import ENDED
from .case_files import portable
from .provenance import attributes
from .resume import differences

if TYPE_CHECKING:
    import xarray

TOLD = ("versions", "plugins", "machine")
"""Attributes of a history about the software and the machine that made it."""


def history_of(directory: Path) -> xarray.Dataset:
    """The history that a run directory holds.

    Raises:
        CaseError: there is none, or it cannot be read.
    """
    file = RunDirectory(directory).history
    try:
        return read_dataset(file)
    except (OSError, RuntimeError, ValueError) as error:
        raise CaseError(f"'{file}' cannot be read as the history of a run: {error}") from None


def made_differently(history: xarray.Dataset, case: Case, threads: int) -> list[str]:
    """Differences from the time when a history was made: the case, versions, plug-ins, machine.

    Threads are left out, because they do not change the results.
    """
    edited = differences(
        json.loads(history.attrs.get("case", "null")), json.loads(json.dumps(portable(case)))
    )
    found = [f"case.json was edited after the run: {sentence}" for sentence in edited]
    now = attributes(case, threads)
    for name in TOLD:
        before = json.loads(history.attrs.get(name, "null"))
        found += differences(before, json.loads(now[name]), name)
    return [sentence for sentence in found if not sentence.startswith("machine.threads")]


def first_difference(before: xarray.Dataset, after: xarray.Dataset) -> str | None:
    """The first difference between two histories of a case, compared bit by bit; None if there is none.

    For a run that did not finish, the common rows except the last are compared: the last row belongs to the
    step at which the run was stopped.
    """
    finished = all(h.attrs.get("stopped_because") in ENDED for h in (before, after))
    rows = min(before.sizes["time"], after.sizes["time"]) - (0 if finished else 1)
    if finished and before.sizes["time"] != after.sizes["time"]:
        return f"the history had {before.sizes['time']} rows and now has {after.sizes['time']}"
    if missing := set(before.data_vars) ^ set(after.data_vars):
        return f"only one of the two has {', '.join(sorted(map(str, missing)))}"
    for name in ("time", *before.data_vars):
        a, b = (h[name].isel(time=slice(rows)).values for h in (before, after))
        a, b = a.reshape(rows, -1), b.reshape(rows, -1)
        width = min(a.shape[1], b.shape[1])  # the longer run may have added particles later
        apart = ~((a[:, :width] == b[:, :width]) | (np.isnan(a[:, :width]) & np.isnan(b[:, :width])))
        if apart.any():
            row = int(apart.any(axis=1).argmax())
            column = int(apart[row].argmax())
            time = float(before.time[row])
            was, now = float(a[row, column]), float(b[row, column])
            return f"{name} at t = {time:.6g} s was {was!r} and is {now!r}"
    return None
