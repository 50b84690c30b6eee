"""The walls of a case: their names, and whether space, grid and walls fit together."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np

from ..registry import audit
from ..registry.blame import blaming_plugins
from .allowed import shown
from .model import Case, Wall

NAME = re.compile(r"[A-Za-z0-9_-]+")
TIMES = 65
"""Times between the start and the end of a run at which a wall is looked for."""
POINTS = 1 << 14
"""Most points of the domain at which it is looked for."""
ROUNDING = 1e-9
"""Part of a cell by which a shell may be thinner than one."""


def check_walls(case: Case) -> None:
    """Raise ValueError with one sentence for the first wall that cannot be one.

    Raises:
        PluginStop: a surface is at fault.
    """
    for name, wall in case.walls.items():
        _check_name(name, case)
        with blaming_plugins([("surface", wall.surface), ("contact", wall.contact)]):
            problem = audit.problem(wall.surface, case.space_)
            if problem is not None:
                raise ValueError(f"walls.{name}.surface: {problem}")
            audit.require_contact(wall.contact)
            _check_surface(f"walls.{name}.surface", wall, case)


def _check_name(name: str, case: Case) -> None:
    if not NAME.fullmatch(name):
        raise ValueError(
            f"walls has a wall called {shown(name)}; its name must be of letters, digits, '_' and '-'"
        )
    if name in case.space_.faces:
        raise ValueError(
            f"walls has a wall called '{name}', which is the name of a face of the grid; give it another name"
        )


def _check_surface(where: str, wall: Wall, case: Case) -> None:
    surface = audit.placed(wall.surface, case.space_)
    cell = case.grid.cell_size
    if surface.thickness < cell * (1 - ROUNDING):
        raise ValueError(
            f"{where} is {surface.thickness:g} m thick, less than a cell of {cell:g} m; a wall with room for "
            "material on both sides must be at least a cell thick"
        )
    if not any(_reaches(surface, case.domain_bounds, case, time) for time in _times(surface, case)):
        raise ValueError(
            f"{where} is outside the domain of the grid at all times of the run, so that no material can "
            "touch it; move it, or leave the wall out"
        )


def _times(surface: audit.AuditedSurface, case: Case) -> Iterator[float]:
    """Times at which a wall is there, or the time at which it appears."""
    times = np.linspace(0.0, case.until, TIMES)
    return (float(time) for time in times if surface.present(float(time)))


def wall_between(case: Case, bounds: tuple[np.ndarray, np.ndarray]) -> bool:
    """Whether a wall that is there at the start may reach into a box between two corners, m."""
    with blaming_plugins([("surface", wall.surface) for wall in case.walls.values()]):
        surfaces = [audit.placed(wall.surface, case.space_) for wall in case.walls.values()]
        return any(surface.present(0.0) and _reaches(surface, bounds, case, 0.0) for surface in surfaces)


def _reaches(
    surface: audit.AuditedSurface, bounds: tuple[np.ndarray, np.ndarray], case: Case, time: float
) -> bool:
    """Whether a wall may be in a box: d changes no faster than the place does."""
    lower, upper = bounds
    extent = upper - lower
    spacing = max(case.grid.cell_size, float(np.prod(extent) / POINTS) ** (1 / len(extent)))
    count = np.maximum(1, np.ceil(extent / spacing)).astype(int)
    index = np.indices(count).reshape(len(count), -1).T
    distance, _ = surface.distance(lower + (index + 0.5) * extent / count, time)
    return bool(distance.min() <= math.hypot(*(extent / count)) / 2)
