"""The data of a report, read from a run directory."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from ..errors import CaseError
from ..output import RunDirectory, read_frames, read_wall_frames
from ..output.near_runs import why_no_run
from ..output.netcdf import read_dataset
from ..output.summary import trusted_rows, trusted_to_the_end


@dataclass(frozen=True)
class RunResults:
    """The results of one run."""

    case: dict[str, Any]
    summary: dict[str, Any]
    history: xarray.Dataset
    """Its rows; without the last row if a guard stopped the run, because this row holds the refused state."""
    frames: Sequence[tuple[float, Path]]
    """Times, s, and files of the frames, in order of time."""
    walls: dict[float, dict[str, Path]]
    """Files of the walls at the times of the frames, s, by name."""

    @property
    def title(self) -> str:
        return str(self.case.get("name", "case"))

    @property
    def stopped_by_guard(self) -> bool:
        """Whether a guard stopped the run, so that its last state must not be trusted."""
        return not trusted_to_the_end(self.summary.get("stopped_because"))

    @property
    def time(self) -> np.ndarray:
        """Times of the rows of the history, s."""
        return self.history["time"].values

    def series(self, name: str) -> np.ndarray | None:
        """A scalar of the history; None if it is missing or has fewer than two rows."""
        if name not in self.history:
            return None
        values = self.history[name].values
        finite = np.isfinite(values)
        return np.where(finite, values, np.nan) if finite.sum() > 1 else None


def read_results(path: Path) -> RunResults:
    """Read a run directory.

    Raises:
        CaseError: where the directory does not hold a run.
    """
    run = RunDirectory(path)
    if not run.history.is_file():
        raise CaseError(f"'{path}' does not hold the results of a run: {why_no_run(run.path)}")
    try:
        history = read_dataset(run.history)
        summary = json.loads(run.summary.read_text(encoding="utf-8"))
        return RunResults(
            case=json.loads(run.case.read_text(encoding="utf-8")),
            summary=summary,
            history=trusted_rows(history, summary.get("stopped_because")),
            frames=read_frames(run.frames),
            walls=read_wall_frames(run.frames),
        )
    except (OSError, json.JSONDecodeError) as error:
        raise CaseError(f"'{path}' does not hold the results of a run: {error}") from error
