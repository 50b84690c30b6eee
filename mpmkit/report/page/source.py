"""The data of a page, read from the directory of a run that may still be in progress."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from ...case import load_case
from ...case.model import Case
from ...case.state_variables import LAW
from ...errors import CaseError, MpmkitError
from ...output import RunDirectory, read_frame, read_frames, read_wall_frames
from ...output.flow import TYPES, Moment, moment_of, read_flow
from ...output.netcdf import read_dataset
from ...output.summary import trusted_rows
from ...spaces import SPACES, Space
from ..domain import inside
from ..run_results import RunResults

LINE = re.compile(r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d,\d+ (?P<level>[A-Z]+) +(?P<said>.*)$")
START = "command: "
"""First line of the log of every start of a run."""


@dataclass(frozen=True)
class Said:
    """A line of the log."""

    level: str
    text: str


@dataclass(frozen=True)
class Source:
    """The data of a run that its page shows."""

    results: RunResults
    moments: list[Moment]
    """of the flow, in order of time, with the particles that can be drawn"""
    log: list[Said]
    case: Case | None
    """None if it cannot be read here, for example if a plug-in is not installed"""
    directory: Path

    @property
    def running(self) -> bool:
        """Whether the run is still in progress."""
        return not self.results.summary

    @property
    def space(self) -> Space:
        return SPACES[self.results.case["space"]]

    @cached_property
    def last_start(self) -> list[Said]:
        """The log since the last start of the run: a continued run writes all its messages again."""
        starts = [row for row, said in enumerate(self.log) if said.text.startswith(START)]
        return self.log[starts[-1] :] if starts else self.log


def read_source(directory: Path) -> Source:
    """Read the files of a run.

    Raises:
        CaseError: there is no run, or its history has no row.
    """
    run = RunDirectory(directory)
    try:
        case = json.loads(run.case.read_text(encoding="utf-8"))
        summary = json.loads(run.summary.read_text(encoding="utf-8")) if run.summary.exists() else {}
        history = read_dataset(run.history)
    except (OSError, ValueError, RuntimeError) as error:
        raise CaseError(f"'{directory}' does not hold the results of a run: {error}") from error
    rows = trusted_rows(history, summary["stopped_because"]) if summary else history
    results = RunResults(case, summary, rows, read_frames(run.frames), read_wall_frames(run.frames))
    moments = read_flow(run.flow) or _moments_of_frames(results)
    drawable = [drawn for moment in moments if len(drawn := _drawable(moment, results))]
    return Source(results, drawable, _read_log(run.log), _read_case(run.case), run.path)


def _moments_of_frames(results: RunResults) -> list[Moment]:
    """The flow from the frames, for a run that saved no data for the player."""
    dim = SPACES[results.case["space"]].dim
    fields_of_case = results.case.get("output", {}).get("fields", {})
    found = []
    for time, path in results.frames:
        frame = read_frame(path)
        number = frame.get("particle", np.arange(len(frame["position"])))
        fields = frame | {"position": frame["position"][:, :dim], "number": number}
        if "half_size" in fields:
            fields["half_size"] = fields["half_size"][:, :dim]
        added = {
            name: values
            for name, values in frame.items()
            if values.ndim == 1 and (name in fields_of_case or name.startswith(LAW))
        }
        if TYPES.keys() <= fields.keys():
            found.append(moment_of(time, 1.0, fields, added))
    return found


def _drawable(moment: Moment, results: RunResults) -> Moment:
    """The particles that are finite and in the domain; the others made a guard stop the run."""
    position = np.zeros((len(moment), 3))
    position[:, : moment.position.shape[1]] = moment.position
    kept = inside(results, position) & np.isfinite(moment.half_size).all(axis=1)
    for values in (moment.speed, moment.shear_rate, moment.pressure):
        kept &= np.isfinite(values)
    return moment if kept.all() else moment.only(kept)


def _read_log(path: Path) -> list[Said]:
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return []
    found = [LINE.match(line) for line in lines]  # lines of a traceback do not match
    return [Said(match["level"], match["said"]) for match in found if match]


def _read_case(path: Path) -> Case | None:
    try:
        return load_case(path)
    except MpmkitError:
        return None
