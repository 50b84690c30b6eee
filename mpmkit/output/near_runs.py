"""Suggestion of an existing run for a missing directory."""

from __future__ import annotations

import difflib
from contextlib import suppress
from itertools import islice
from pathlib import Path

RUNS = Path("runs")
"""Default directory of runs."""
MOST = 1000
"""Most directories that are compared."""
LIKE = 0.75
"""Least similarity of two names, from 0 to 1, that counts as a typing error."""


def why_no_run(directory: str | Path) -> str:
    """Why a directory holds no run, and a suggestion, as the end of a sentence."""
    path = Path(directory)
    if path.is_dir():
        return "it is a directory of something else, or of a run that has not ended"
    near = near_run(path)
    return "there is no such directory" + ("" if near is None else f"; did you mean '{near}'?")


def near_run(path: Path) -> Path | None:
    """The run directory with the name most similar to that of a path, in the same folder or in ``runs/``."""
    best, found = LIKE, None
    for folder in dict.fromkeys((path.parent, RUNS)):
        with suppress(OSError, ValueError):  # no such folder, or an impossible path
            for run in islice(sorted(folder.iterdir()), MOST):
                likeness = difflib.SequenceMatcher(None, path.name.casefold(), run.name.casefold()).ratio()
                if likeness > best and (run / "case.json").is_file():
                    best, found = likeness, run
    return found
