"""Walls in the plane of a picture, as line segments, and how they are drawn."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from ..output import read_wall_frame
from ..spaces import SPACES
from .domain import Domain
from .run_results import RunResults
from .style import FACE_COLOURS, MILLIMETRES, WALL_COLOURS

WIDTHS = (1.8, 0.9)
"""Widths of lines, points: those of the first walls, and of others that have the same colours."""
ASIDE = 1e-6
"""Distance of a section from its plane, in cells, so that walls that end at a plane of symmetry are cut."""

Lines = dict[str, np.ndarray]
"""Segments by wall, m, (s, 2, 2): their ends along (horizontal, vertical)."""


def wall_lines(results: RunResults, time: float, plane: float | None, domain: Domain) -> Lines:
    """The walls present at the time of a frame, s, in the section along y = ``plane``, m.

    Parts cut by a plane of symmetry are drawn whole, like the material.
    """
    found = {}
    for name, path in results.walls.get(time, {}).items():
        points, parts, _ = read_wall_frame(path)
        if plane is None:
            segments = points[parts][..., :2]
        else:
            segments = _cut(points, parts, plane + _aside(results, plane))
        if domain.mirror is not None:
            image = segments * [-1, 1] + [2 * domain.mirror, 0]
            segments = np.concatenate([segments, image])
        found[name] = segments
    return found


def looks(names: Sequence[str], walls: Collection[str]) -> dict[str, dict[str, Any]]:
    """Colour and width of the line of every name, of a wall or else of a face: the same in all pictures."""
    of_walls, of_faces = _looks(WALL_COLOURS), _looks(FACE_COLOURS)
    found = {name: next(of_walls) for name in walls}
    return found | {name: next(of_faces) for name in names if name not in walls}


def _looks(colours: Sequence[str]) -> Iterator[dict[str, Any]]:
    while True:
        for width, colour in product(WIDTHS, colours):
            yield {"color": colour, "linewidth": width}


def draw_walls(axes: Axes, lines: Lines, looks: dict[str, dict[str, Any]]) -> None:
    """Draw walls, each with its look."""
    for name, segments in lines.items():
        drawn = LineCollection([*(segments * MILLIMETRES)], capstyle="round", zorder=3, **looks[name])
        axes.add_collection(drawn, autolim=False)
        drawn.set_in_layout(False)  # parts outside the panel need no space beside it


def legend_handles(looks: dict[str, dict[str, Any]], shown: set[str]) -> list[Line2D]:
    """Legend entries of the walls that are ``shown``."""
    return [Line2D([], [], label=name, **look) for name, look in looks.items() if name in shown]


def _aside(results: RunResults, plane: float) -> float:
    middle = np.mean(results.case["grid"]["domain"]["y"])
    return float(np.sign(middle - plane)) * ASIDE * results.case["grid"]["cell_size"]


def _cut(points: np.ndarray, parts: np.ndarray, plane: float) -> np.ndarray:
    """Where y = ``plane``, m, cuts triangles: segments along x and z, (s, 2, 2)."""
    y, vertical = points[:, 1] - plane, SPACES["3d"].axes.index("z")
    across = [points[:, [0, vertical]][parts], y[parts]]
    cut = (across[1] >= 0).any(axis=1) & (across[1] < 0).any(axis=1)
    places, off = across[0][cut], across[1][cut]
    # The corner that is alone on its side comes first: the plane cuts the edges from it to the two others.
    above = off >= 0
    alone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)
    order = (alone[:, None] + np.arange(3)) % 3
    places = np.take_along_axis(places, order[:, :, None], axis=1)
    off = np.take_along_axis(off, order, axis=1)
    part = off[:, :1] / (off[:, :1] - off[:, 1:])
    return places[:, :1] + part[:, :, None] * (places[:, 1:] - places[:, :1])
