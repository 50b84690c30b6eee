"""The walls of a case: their names, and their consistency with space and grid."""

from __future__ import annotations

import math
import re

import numpy as np

from ..registry import audit
from ..registry.blame import blaming_plugins
from .allowed import shown
from .model import Case, Wall
from .shapes import check_shape, shapes_in

NAME = re.compile(r"[A-Za-z0-9_-]+")
TIMES = 64
"""Times in a run at which a wall near the domain is checked."""
POINTS = 1 << 14
"""Most points of the domain at which it is checked."""
MOST_SPEED = 1e6
"""m/s; faster than any real wall, and slow enough that results do not overflow."""
FACE_POINTS, FACE_TIMES = 33, 17
"""Points along each axis of a face, and times in a run, at which a wall on the face is checked."""
REACHED, OVER = 0.02, 0.7
"""Cells to which a wall has reached a face; cosine of the angle of their normals above which it covers it."""
ROUNDING = 1e-9
"""Part of a cell by which a shell may be thinner than one."""


def check_walls(case: Case) -> None:
    """Raise ValueError with one sentence for the first wall that is not valid.

    Raises:
        PluginStop: a surface is at fault.
    """
    for name, wall in case.walls.items():
        _check_name(name, case)
        for field, shape in shapes_in(wall.surface).items():
            check_shape(f"walls.{name}.surface.{field}", shape, case.space_)
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
    fastest = surface.fastest(0.0, case.end)
    if fastest > MOST_SPEED:
        raise ValueError(f"{where} moves at {fastest:.3g} m/s; it must be at most {MOST_SPEED:g} m/s")
    if not _comes_into_the_domain(surface, case):
        raise ValueError(
            f"{where} is outside the domain of the grid at all times of the run, so that no material can "
            "touch it; move it, or leave the wall out"
        )
    plane = _leaves_a_plane_of_symmetry(surface, case)
    if plane is not None:
        raise ValueError(
            f"{where} moves into the scene from {plane}, a plane of symmetry, which still holds the "
            f"material there; let grid.faces.{plane} be 'open', or 'slip'"
        )


def _leaves_a_plane_of_symmetry(surface: audit.AuditedSurface, case: Case) -> str | None:
    """The plane of symmetry that a wall crosses inwards, if any; checked at some times."""
    cell = case.grid.cell_size
    lower, upper = case.domain_bounds
    for face in (name for name, kind in case.grid.faces.items() if kind == "symmetry"):
        axis, inward = case.space_.axes.index(face[0]), 1.0 if face.endswith("min") else -1.0
        ends = [np.linspace(low, high, FACE_POINTS) for low, high in zip(lower, upper, strict=True)]
        ends[axis] = (lower if inward > 0 else upper)[axis : axis + 1]
        points = np.stack(np.meshgrid(*ends, indexing="ij"), axis=-1).reshape(-1, len(ends))
        for time in np.linspace(0.0, case.end, FACE_TIMES):
            if not surface.present(time) or not surface.fastest(time, time) > 0:
                continue
            distance, normal = surface.distance(points, time)
            over = (distance <= REACHED * cell) & (normal[:, axis] * inward > OVER)
            if over.any() and (surface.velocity(points[over], time)[:, axis] * inward > 0).any():
                return face
    return None


def _comes_into_the_domain(surface: audit.AuditedSurface, case: Case) -> bool:
    """Whether a wall may be in the domain at some time of the run.

    A wall that is far away is checked again after the time in which it can arrive at its largest speed.
    """
    time, soon = 0.0, case.end / TIMES
    while time <= case.end:
        gap, fastest = _gap(surface, case.domain_bounds, case, time), surface.fastest(time, case.end)
        if gap <= 0 and surface.present(time):
            return True
        if gap > fastest * (case.end - time):
            return False
        time += max(soon, gap / fastest if fastest > 0 else 0.0)
    return False


def wall_between(case: Case, bounds: tuple[np.ndarray, np.ndarray]) -> bool:
    """Whether a wall present at the start may reach into a box between two corners, m."""
    with blaming_plugins([("surface", wall.surface) for wall in case.walls.values()]):
        surfaces = [audit.placed(wall.surface, case.space_) for wall in case.walls.values()]
        return any(surface.present(0.0) and _gap(surface, bounds, case, 0.0) <= 0 for surface in surfaces)


def _gap(
    surface: audit.AuditedSurface, bounds: tuple[np.ndarray, np.ndarray], case: Case, time: float
) -> float:
    """Lower bound of the distance, m, of a wall from a box; 0 or less if it may be in the box.

    The distance d is known at points, and changes at most as much as the position.
    """
    lower, upper = bounds
    extent = upper - lower
    spacing = case.grid.cell_size
    while np.prod(count := np.ceil(extent / spacing)) > POINTS:
        spacing *= 2
    count = count.astype(int)
    index = np.indices(count).reshape(len(count), -1).T
    distance, _ = surface.distance(lower + (index + 0.5) * extent / count, time)
    return float(distance.min()) - math.hypot(*(extent / count)) / 2
