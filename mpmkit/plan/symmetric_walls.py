"""Whether walls have the symmetry of a scene: checked at points, for any kind of surface."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np

from ..case.model import Case
from ..registry import audit
from ..registry.audit import AuditedSurface
from ..registry.blame import blaming_plugins

POINTS = 400
TIMES = 9
"""Number of checked times of a run; if a wall moves between two of them, one more time is checked."""
HALVINGS = 20
"""Parts of the time between two of them, to find a moment at which it moves."""
ROUNDING = 1e-9
"""Tolerance of distances over the extent of the domain, and of velocities over the largest."""
Map = Callable[[np.ndarray], np.ndarray]
"""A map of points or vectors, (k, dim)."""


def are_mirrored(case: Case, middle: tuple[float, float]) -> bool:
    """Whether planes x = const and y = const mirror every wall of a scene in 3-D, and its motion."""
    for axis, place in enumerate(middle):
        turned_round, about = np.ones(3), np.zeros(3)
        turned_round[axis], about[axis] = -1.0, 2 * place
        if not _same(case, case, partial(_scaled, turned_round, about), partial(_scaled, turned_round, 0.0)):
            return False
    return True


def _scaled(factor: np.ndarray, shift: np.ndarray | float, x: np.ndarray) -> np.ndarray:
    return factor * x + shift


def are_turned(case: Case, flat: Case, axis: tuple[float, float]) -> bool:
    """Whether the walls of an axisymmetric scene, turned about a vertical axis, are those of one in 3-D."""
    angle = np.random.default_rng(1).uniform(0, 2 * np.pi, POINTS)
    outwards = np.column_stack([np.cos(angle), np.sin(angle)])

    def turned(x: np.ndarray) -> np.ndarray:
        return np.column_stack([axis + x[:, :1] * outwards, x[:, 1]])

    return _same(flat, case, turned, lambda v: np.column_stack([v[:, :1] * outwards, v[:, 1]]))


def _same(case: Case, other: Case, place: Map, vector: Map) -> bool:
    """Whether each wall of a case, at points mapped by ``place``, is that of the other; velocities by
    ``vector``."""
    with blaming_plugins([("surface", wall.surface) for wall in case.walls.values()]):
        pairs = [
            (audit.placed(wall.surface, case.space_), audit.placed(other.walls[name].surface, other.space_))
            for name, wall in case.walls.items()
        ]
        return all(
            _alike(here, there, case, time, place, vector)
            for here, there in pairs
            for time in _moments(here, case.end)
        )


def _moments(surface: AuditedSurface, until: float) -> list[float]:
    """Times, s, at which a wall is checked."""
    times = np.linspace(0.0, until, TIMES).tolist()
    moving = [(a, b) for a, b in pairwise(times) if surface.fastest(a, b) > 0]
    return times + [_in_motion(surface, a, b) for a, b in moving]


def _in_motion(surface: AuditedSurface, before: float, after: float) -> float:
    """A time at which a wall moves, shortly after the first at which it does, of those between two."""
    for _ in range(HALVINGS):
        middle = (before + after) / 2
        before, after = (before, middle) if surface.fastest(before, middle) > 0 else (middle, after)
    return after


def _alike(
    here: AuditedSurface, there: AuditedSurface, case: Case, time: float, place: Map, vector: Map
) -> bool:
    lower, upper = case.domain_bounds
    x = np.random.default_rng(0).uniform(lower, upper, (POINTS, len(lower)))
    apart = np.abs(here.distance(x, time)[0] - there.distance(place(x), time)[0]).max()
    off = np.abs(vector(here.velocity(x, time)) - there.velocity(place(x), time)).max()
    return (
        here.present(time) == there.present(time)
        and apart <= ROUNDING * float((upper - lower).max())
        and off <= ROUNDING * here.fastest(0.0, case.end)
    )
