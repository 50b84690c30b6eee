"""Bodies that overlap a wall at the start."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..case.model import Case
from ..errors import CaseError
from ..geometry import Sample
from ..registry import audit
from ..registry.blame import blaming_plugins

ROUNDING = 0.25
"""How deep the centre of a particle may be in a wall, relative to the half-width of its box along the normal:
the outline of a body is only known to a particle's size, and a mesh may be a polygon beside a round wall."""


def refuse_overlaps_with_walls(case: Case, samples: Iterable[tuple[int, Sample]]) -> None:
    """Refuse bodies whose particles overlap a wall that is present at the start.

    A particle counts only if its centre is in the wall, with the part of its box beyond the surface.

    Args:
        case: the scene.
        samples: number of each body in the case, and its particles, in scene coordinates.

    Raises:
        CaseError: names body, wall, volume and place.
        PluginStop: a surface is at fault.
    """
    surfaces = [("surface", wall.surface) for wall in case.walls.values()]
    with blaming_plugins(surfaces):
        walls = {name: audit.placed(wall.surface, case.space_) for name, wall in case.walls.items()}
        present = {name: surface for name, surface in walls.items() if surface.present(0.0)}
        for number, sample in samples:
            for name, surface in present.items():
                _refuse(number, sample, name, *surface.distance(sample.position, 0.0))


def _refuse(number: int, sample: Sample, name: str, distance: np.ndarray, normal: np.ndarray) -> None:
    half_width = (np.abs(normal) * sample.half_size).sum(axis=1)
    beyond = distance < -ROUNDING * half_width
    if not beyond.any():
        return
    part = np.minimum((1 - distance / half_width) / 2, 1.0)
    volume = float((part * sample.volume)[beyond].sum())
    deepest = int(np.argmin(distance))
    place = ", ".join(f"{c:.4g}" for c in sample.position[deepest])
    raise CaseError(
        f"bodies.{number}.shape overlaps the wall '{name}': about {volume:.3g} m³, "
        f"{volume / float(sample.volume.sum()):.2g} of it, is in the wall, deepest at ({place}) m, by "
        f"{-distance[deepest]:.3g} m; a body may touch a wall but not overlap it"
    )
