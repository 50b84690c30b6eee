"""The file that somebody means who names one that is not there."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

FOLDERS = ("", "cases", "cases/studies")
"""Where files are looked for beside the folder that is named, from the working directory."""
MOST = 1000
"""Files that are looked at."""
LIKE = 0.75
"""Least likeness of two names, from 0 to 1, that is taken for a slip of the hand."""


def near_file(path: str | Path, suffix: str = ".json") -> Path | None:
    """The file with the suffix whose name is nearest to that of a path; None if none is near.

    Looked at are the folder of the path and the folders of cases. The same name in another folder, or without
    its ending, counts as the nearest.
    """
    wanted = Path(path)
    stem = wanted.stem.casefold()
    best, found = LIKE, None
    for file in _files(wanted, suffix):
        likeness = difflib.SequenceMatcher(None, stem, file.stem.casefold()).ratio()
        if likeness > best:
            best, found = likeness, file
    return found


def _files(wanted: Path, suffix: str) -> Iterator[Path]:
    """Files of the folder of the path first: of equally near ones, the first is meant."""
    seen = 0
    for folder in dict.fromkeys((wanted.parent, *map(Path, FOLDERS))):
        with suppress(OSError, ValueError):  # no such folder, or a path that there cannot be
            for file in sorted(folder.iterdir()):
                if file.suffix == suffix and file.is_file():
                    seen += 1
                    if seen > MOST:
                        return
                    yield file
