"""A case as a small picture: the domain, its faces, the bodies and the walls at the start, as SVG."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import numpy as np

from ..registry import audit
from .model import Case

ACROSS = 240
"""Pixels of the longer side of the domain."""
MARGIN = 6
BODIES = ("#0072B2", "#009E73", "#56B4E9", "#CC79A7")
WALL, CLOSED, OPEN = "#D55E00", "currentColor", "#BBBBBB"


def picture(case: Case) -> str:
    """The case in the plane of its first and its last axis; in 3-D, a section through the middle of it.

    Raises:
        MpmkitError: a shape cannot be drawn, such as a mesh without the packages that it needs.
        Exception: whatever a plug-in raises.
    """
    lower, upper = (end[[0, -1]] for end in case.domain_bounds)
    size = upper - lower
    per_metre = ACROSS / float(size.max())
    columns, rows = (max(1, round(float(side) * per_metre)) for side in size)
    points = _points(case, columns, rows)
    parts = [
        _filled(body.shape.contains(points, case.space_).reshape(rows, columns), BODIES[number % len(BODIES)])
        for number, body in enumerate(case.bodies)
    ]
    for wall in case.walls.values():
        surface = audit.placed(wall.surface, case.space_)
        if surface.present(0.0):
            inside = (surface.distance(points, 0.0)[0] <= 0).reshape(rows, columns)
            parts.append(_filled(inside, WALL))
    width, height = columns + 2 * MARGIN, rows + 2 * MARGIN
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{-MARGIN} {-MARGIN} {width} {height}" '
        f'width="{width}" height="{height}" role="img" aria-label="{case.name} at the start">'
        f'<g shape-rendering="crispEdges">{"".join(parts)}</g>{"".join(_faces(case, columns, rows))}</svg>'
    )


def _points(case: Case, columns: int, rows: int) -> np.ndarray:
    """Middles of the pixels, m, row by row from the top; in 3-D in a plane of symmetry, or the middle."""
    lower, upper = case.domain_bounds
    along = lower[0] + (np.arange(columns) + 0.5) / columns * (upper[0] - lower[0])
    up = upper[-1] - (np.arange(rows) + 0.5) / rows * (upper[-1] - lower[-1])
    first, last = np.meshgrid(along, up)
    if case.space_.dim == 2:
        return np.column_stack([first.ravel(), last.ravel()])
    middle = lower[1] if case.grid.faces.get("y_min") == "symmetry" else _middle_of_bodies(case)
    return np.column_stack([first.ravel(), np.full(first.size, middle), last.ravel()])


def _middle_of_bodies(case: Case) -> float:
    bounds = [body.shape.bounds(case.space_) for body in case.bodies]
    middles = [mouth.centre[1] for mouth in case.mouths.values()]
    ends = [low[1] for low, _ in bounds] + [high[1] for _, high in bounds] + middles
    return (min(ends) + max(ends)) / 2


def _filled(inside: np.ndarray, colour: str) -> str:
    """The pixels that are inside, one rectangle for each run of them in a row."""
    path = [
        f"M{begin} {row}h{length}v1h{-length}z"
        for row, line in enumerate(inside)
        for begin, length in _runs(line)
    ]
    return f'<path fill="{colour}" d="{"".join(path)}"/>'


def _runs(line: np.ndarray) -> Iterator[tuple[int, int]]:
    begin = 0
    for is_inside, pixels in groupby(line.tolist()):
        length = len(list(pixels))
        if is_inside:
            yield begin, length
        begin += length


def _faces(case: Case, columns: int, rows: int) -> Iterator[str]:
    first, last = case.space_.axes[0], case.space_.axes[-1]
    ends = {
        f"{first}_min": (0, 0, 0, rows),
        f"{first}_max": (columns, 0, columns, rows),
        f"{last}_min": (0, rows, columns, rows),
        f"{last}_max": (0, 0, columns, 0),
    }
    for name, (x1, y1, x2, y2) in ends.items():
        face = case.grid.faces.get(name, "open")
        axis = case.space_.radial and name == "r_min"
        closed = face not in ("open", "periodic", "symmetry") and not axis
        look = f'stroke="{CLOSED}" stroke-width="2"' if closed else f'stroke="{OPEN}"'
        dashes = ' stroke-dasharray="6 2 1 2"' if axis or face == "symmetry" else ""
        yield f'<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" {look}{dashes}/>'
