"""Folders of compiled code, and the removal of old files, only those of mpmkit.

All files are in one folder, ``mpmkit-compiled``, in the user's cache directory, or in ``NUMBA_CACHE_DIR`` if
that is set. In it each package has one folder for each state of its sources, called a *generation*. Files
are removed only from a folder that has our marker file, and only those with our file endings.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

from platformdirs import user_cache_path

FOLDER = "mpmkit-compiled"
MARKER = "CACHEDIR.TAG"
TAG = "Signature: 8a477f597d28d172789f06886806bc55\n# Compiled kernels of mpmkit: they may be deleted.\n"
"""See https://bford.info/cachedir: backup programs skip such a folder."""
CODE, PARTIAL = ".code", ".code.partial"
KEPT = 4
"""Generations of compiled code that are kept for a package: a developer may switch between branches."""
VERSIONS = 32
"""Files that are kept for a function in a generation, one for each set of argument types and constants."""
IN_USE = 86_400
"""Everything used in the last so many seconds is kept: a run may be using it."""


@cache
def cache_root() -> Path | None:
    """The folder of all compiled code; None if no folder can be written."""
    given = os.environ.get("NUMBA_CACHE_DIR")
    shared = Path(tempfile.gettempdir()) / "mpmkit"
    for place in [Path(given)] if given else [user_cache_path("mpmkit"), shared]:
        root = place / FOLDER
        try:
            root.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=root):
                pass
            if place != shared or _is_mine(root):
                return root.absolute()  # absolute: the working directory may change
        except OSError:
            continue
    return None


def _is_mine(folder: Path) -> bool:
    """Whether this user owns a folder in a place that all users share: its files are executed."""
    return not hasattr(os, "getuid") or folder.stat().st_uid == os.getuid()


def read(path: Path) -> bytes:
    """Read a file of compiled code, and set the time of its last use to now.

    Raises:
        OSError: there is no such file.
    """
    content = path.read_bytes()
    with suppress(OSError):
        os.utime(path)
        os.utime(path.parent)
    return content


def write(path: Path, content: bytes) -> None:
    """Add a file ``<function>.<key>.code`` to a generation, and remove what has long not been used.

    Raises:
        OSError: it cannot be written.
    """
    generation = path.parent
    if not generation.exists():
        generation.mkdir(exist_ok=True)
        forget_generations(generation.parent, generation.name.rpartition("-")[0])
    if not any(generation.iterdir()):
        (generation / MARKER).write_text(TAG, encoding="utf-8")
    partial = path.with_name(f"{path.stem}.{os.getpid()}{PARTIAL}")
    try:
        partial.write_bytes(content)
        os.replace(partial, path)
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
    forget_versions(generation, path.name.partition(".")[0])


def forget_generations(root: Path, package: str) -> None:
    """Remove the compiled code of old sources, except the generations that were used last."""
    generations = [path for path in root.glob("*-*") if path.name.rpartition("-")[0] == package]
    for generation in _forgotten(filter(_is_ours, generations), KEPT):
        with suppress(OSError):
            for path in (*generation.glob(f"*{CODE}"), *generation.glob(f"*{PARTIAL}")):
                path.unlink(missing_ok=True)
            if {path.name for path in generation.iterdir()} == {MARKER}:
                (generation / MARKER).unlink()
                generation.rmdir()


def forget_versions(generation: Path, function: str) -> None:
    """Remove the code of a function for argument types and constants that have long not been used."""
    if not _is_ours(generation):
        return
    versions = [path for path in generation.glob(f"*{CODE}") if path.name.partition(".")[0] == function]
    for path in (*_forgotten(versions, VERSIONS), *_forgotten(generation.glob(f"*{PARTIAL}"), 0)):
        with suppress(OSError):
            path.unlink(missing_ok=True)


def _is_ours(folder: Path) -> bool:
    try:
        return not folder.is_symlink() and (folder / MARKER).read_text(encoding="utf-8") == TAG
    except (OSError, UnicodeDecodeError):
        return False


def _forgotten(paths: Iterable[Path], kept: int) -> Iterator[Path]:
    """All paths except the ``kept`` that were used last and those that were used within a day."""
    used = []
    for path in paths:
        with suppress(OSError):  # another process may have removed it
            used.append((path.stat().st_mtime, path))
    for when, path in sorted(used, reverse=True)[kept:]:
        if time.time() - when > IN_USE:
            yield path
