"""Where compiled kernels are kept, so that only the first run compiles.

numba looks at the file of a kernel alone: if another file changes, a function that the kernel calls or a
constant that it was compiled with, the old code would go on being used. So the compiled code of a package is
kept under a digest of *all* its sources and of those of ``mpmkit.kernels``. What belongs to sources that are
no more is removed.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba
from platformdirs import user_cache_path

KEPT = 4
"""Generations of compiled code that are kept of a package: branches that are worked on in turn."""
IN_USE = 86_400
"""Seconds since its last use for which an older generation is kept all the same: a run may be using it."""
KERNELS = Path(__file__).parent


def cached_code(compiler: Callable[..., Callable], *arguments: Any, **options: Any) -> Callable:
    """``compiler(*arguments, cache=True, **options)`` as a decorator whose code outlives the process."""

    def decorate(python_function: Callable) -> Callable:
        directory = _directory(python_function.__module__)
        if directory is None:
            return compiler(*arguments, **options)(python_function)
        before = numba.config.CACHE_DIR
        numba.config.CACHE_DIR = str(directory)  # numba asks for it when it decorates, and never again
        try:
            return compiler(*arguments, cache=True, **options)(python_function)
        finally:
            numba.config.CACHE_DIR = before

    return decorate


@cache
def cache_root() -> Path | None:
    """``NUMBA_CACHE_DIR`` if it is set, or the user's cache directory; None where nothing can be written."""
    given = os.environ.get("NUMBA_CACHE_DIR")
    places = [Path(given)] if given else [user_cache_path("mpmkit"), Path(tempfile.gettempdir()) / "mpmkit"]
    for place in places:
        try:
            place.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=place):
                return place
        except OSError:
            continue
    return None


def _directory(module: str) -> Path | None:
    """Where the compiled code of a module's package belongs; None if there is no place for it."""
    root = cache_root()
    return None if root is None else _generation(root, *_package(module))


def _package(module: str) -> tuple[str, tuple[Path, ...]]:
    """Name and sources of the package that a module belongs to; of mpmkit itself, its kernels alone."""
    top = module.partition(".")[0]
    if top == "mpmkit":
        return "mpmkit", (KERNELS,)
    found = sys.modules.get(top)
    folders = getattr(found, "__path__", None)
    if folders is not None:
        return top, tuple(Path(folder) for folder in folders)
    file = getattr(found, "__file__", None)
    return top, () if file is None else (Path(file),)


@cache
def _generation(root: Path, name: str, sources: tuple[Path, ...]) -> Path | None:
    versions = (sys.version, numba.__version__)
    directory = root / f"{name}-{digest((KERNELS, *sources), versions)}"
    new = not directory.exists()
    try:
        directory.mkdir(exist_ok=True)
        os.utime(directory)
    except OSError:
        return None
    if new:
        forget_old_generations(root, name)
    return directory


def digest(sources: tuple[Path, ...], versions: tuple[str, ...] = ()) -> str:
    """Of the content of all Python files in these folders, or of these files."""
    total = hashlib.sha256("\0".join(versions).encode())
    for source in sources:
        files = sorted(source.rglob("*.py")) if source.is_dir() else [source]
        for file in filter(Path.is_file, files):  # an editor's lock is a link to nowhere
            total.update(str(file).encode() + b"\0" + file.read_bytes())
    return total.hexdigest()[:16]


def forget_old_generations(root: Path, name: str) -> None:
    """Remove the compiled code of sources that are no more, but for the last few used."""
    generations = []
    for path in root.glob(f"{name}-*"):
        with suppress(OSError):  # another process may have removed it
            if path.name.rpartition("-")[0] == name:
                generations.append((path.stat().st_mtime, path))
    for used, path in sorted(generations, reverse=True)[KEPT:]:
        if time.time() - used > IN_USE:
            shutil.rmtree(path, ignore_errors=True)
