"""The results that a run has written so far."""

from __future__ import annotations

import json
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..case.ending import latest
from ..output import RunDirectory
from ..output.netcdf import read_scalars

MOST_ROWS = 1000
"""Most rows of a history that are sent; a screen cannot show more."""
NOTHING = "nothing yet"
"""Version as long as the run has not written a row."""


@dataclass(frozen=True)
class Series:
    """A scalar of the history."""

    label: str
    unit: str
    values: list[float | None]


class SoFar:
    """The history of a run in progress, read when it has changed.

    Args:
        directory: of the run.
        resumed: whether a history that exists now belongs to this run, and not to an earlier run.
    """

    def __init__(self, directory: Path, resumed: bool) -> None:
        self.run = RunDirectory(directory)
        self._of_another = NOTHING if resumed else self._written()
        self._lock = threading.Lock()
        self._read = (NOTHING, self._empty())

    def version(self) -> str:
        """A text that changes when the run has written something that its page shows."""
        written = self._written()
        if written in (NOTHING, self._of_another):
            return NOTHING
        return f"{written} {_stamp(self.run.flow)} {_stamp(self.run.summary)}"

    def time(self) -> float | None:
        """Simulated time of the last row, s; None before there is one."""
        time = self.history()["time"]
        return time[-1] if time else None

    def history(self) -> dict[str, Any]:
        """``version``, ``name``, ``until`` (s), ``time`` (s) and ``series`` by name."""
        with self._lock:
            version = self.version()
            if version != self._read[0]:
                self._read = (version, self._empty() if version == NOTHING else self._load(version))
            return self._read[1]

    def _written(self) -> str:
        return _stamp(self.run.history) or NOTHING

    def _empty(self) -> dict[str, Any]:
        return {
            "version": NOTHING,
            "name": self.run.path.resolve().name,
            "until": None,
            "time": [],
            "series": {},
        }

    def _load(self, version: str) -> dict[str, Any]:
        """Read the history; if it is just being replaced, the next call reads it."""
        try:
            time, series = _scalars(self.run.history)
            case = json.loads(self.run.case.read_text(encoding="utf-8"))
        except (OSError, ValueError, RuntimeError):
            return self._empty()
        return {
            "version": version,
            "name": str(case.get("name", self.run.path.name)),
            "until": latest(case["until"]),
            "time": time,
            "series": {name: vars(one) for name, one in series.items()},
        }


def _scalars(path: Path) -> tuple[list[float | None], dict[str, Series]]:
    """Times, s, and the scalars of a history by name. Fields of particles can be large and are not read.

    Raises:
        OSError, RuntimeError: the file is missing or incomplete.
    """
    scalars = read_scalars(path)
    count = len(scalars["time"][0])
    rows = np.unique(np.linspace(0, max(0, count - 1), min(count, MOST_ROWS)).round().astype(int))
    found = {
        name: Series(long_name, units, _listed(values[rows]))
        for name, (values, long_name, units) in scalars.items()
    }
    return found.pop("time").values, found


def _stamp(path: Path) -> str:
    """A text that changes when the file is replaced; empty if there is no file."""
    try:
        found = path.stat()
    except OSError:
        return ""
    return f"{found.st_mtime_ns}-{found.st_ino}"


def _listed(values: np.ndarray) -> list[float | None]:
    """Numbers for JSON; None for values that are not finite."""
    return [float(value) if np.isfinite(value) else None for value in values]
