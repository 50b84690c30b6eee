"""Suggestion of an existing file for a missing one."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

FOLDERS = ("", "cases", "cases/studies")
"""Folders that are searched besides the named one, relative to the working directory."""
MOST = 1000
"""Most files that are compared."""
LIKE = 0.75
"""Least similarity of two names, from 0 to 1, that counts as a typing error."""


def near_file(path: str | Path, suffix: str = ".json") -> Path | None:
    """The file with this suffix whose name is most similar to that of a path; None if none is similar.

    The folder of the path and the folders of cases are searched. The same name in another folder, or without
    its ending, counts as the most similar.
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
    """Files of the folder of the path first: among equally similar files, the first is suggested."""
    seen = 0
    for folder in dict.fromkeys((wanted.parent, *map(Path, FOLDERS))):
        with suppress(OSError, ValueError):  # no such folder, or an impossible path
            for file in sorted(folder.iterdir()):
                if file.suffix == suffix and file.is_file():
                    seen += 1
                    if seen > MOST:
                        return
                    yield file
