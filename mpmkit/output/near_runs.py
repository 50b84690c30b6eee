"""The run that somebody means who names a directory that is not there."""

from __future__ import annotations

import difflib
from contextlib import suppress
from itertools import islice
from pathlib import Path

RUNS = Path("runs")
"""Where runs are by default."""
MOST = 1000
"""Directories that are looked at."""
LIKE = 0.75
"""Least likeness of two names, from 0 to 1, that is taken for a slip of the hand."""


def why_no_run(directory: str | Path) -> str:
    """Why a directory holds no run, and which one may be meant, as the end of a sentence."""
    path = Path(directory)
    if path.is_dir():
        return "it is a directory of something else, or of a run that has not ended"
    near = near_run(path)
    return "there is no such directory" + ("" if near is None else f"; did you mean '{near}'?")


def near_run(path: Path) -> Path | None:
    """The directory of a run whose name is nearest to that of a path, beside it or in ``runs/``."""
    best, found = LIKE, None
    for folder in dict.fromkeys((path.parent, RUNS)):
        with suppress(OSError, ValueError):  # no such folder, or a path that there cannot be
            for run in islice(sorted(folder.iterdir()), MOST):
                likeness = difflib.SequenceMatcher(None, path.name.casefold(), run.name.casefold()).ratio()
                if likeness > best and (run / "case.json").is_file():
                    best, found = likeness, run
    return found
