"""Two changes of the same place of a case: the later one would silently replace the earlier one."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping

Place = tuple[str | int, ...]


def place(path: str) -> Place:
    """The keys of a path; two paths of one place are equal: ``bodies.0`` and ``bodies.00``."""
    return tuple(int(key) if key.isascii() and key.isdigit() else key for key in path.split("."))


def within(inner: str, outer: str) -> bool:
    """Whether a path leads to the place of another path, or to a part of that place."""
    return place(inner)[: len(place(outer))] == place(outer)


def clash(dimensions: Mapping[str, Iterable[str]]) -> str | None:
    """A sentence that names two dimensions of a grid that change the same place of the case; None if none do.

    Args:
        dimensions: the paths that each dimension changes, by its name.
    """
    for (one, paths), (other, others) in itertools.combinations(dimensions.items(), 2):
        for path, another in itertools.product(paths, others):
            if within(path, another) or within(another, path):
                return (
                    f"vary.{one} and vary.{other} change the same place of the case: "
                    f"{_said(path, another)}; vary it in one of them only"
                )
    return None


def _said(path: str, another: str) -> str:
    if place(path) == place(another):
        return f"both set {path}"
    inner, outer = (path, another) if within(path, another) else (another, path)
    return f"{inner} is a part of {outer}"


def replaced(given: Iterable[str], varied: Iterable[str]) -> tuple[str, str] | None:
    """A path given for all members, and a varied path of which it is only a part; None if there is none."""
    for path, outer in itertools.product(given, varied):
        if within(path, outer) and place(path) != place(outer):
            return path, outer
    return None
