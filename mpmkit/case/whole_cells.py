"""A domain that is not a whole number of cells: it is extended, or the message names the nearest cell sizes.

An open face has no effect on the material, so that it can be moved. A closed face, or a period, is a part of
the scene: its position is not changed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from .model import Case

WHOLE = 1e-6
"""How far, in cells, a length may be from a whole number of cells and still count as whole."""
MOST_TRIED = 10_000
"""Numbers of cells that are tried to find a suitable size."""


def cells_along(case: Case, axis: str) -> float:
    """Length of the domain along an axis, in cells."""
    lower, upper = case.grid.domain[axis]
    return (upper - lower) / case.grid.cell_size


def is_whole(cells: float) -> bool:
    """Whether a length in cells counts as a whole number of cells, of at least one."""
    return round(cells) >= 1 and abs(cells - round(cells)) <= WHOLE * max(1.0, cells)


def extend_domain(case: Case) -> None:
    """Extend the domain of a case to whole cells at its open faces, and note it in ``grid.extensions``.

    The upper end is moved if its face is open, so that the nodes stay where they are; else the lower end.

    Raises:
        ValueError: both faces of an axis are closed; the sentence names the nearest sizes that fit.
    """
    for axis in case.space_.axes:
        cells, cell = cells_along(case, axis), case.grid.cell_size
        if is_whole(cells):
            continue
        side = _open_side(case, axis)
        lower, upper = case.grid.domain[axis]
        if side is None:
            raise ValueError(_misfit(case, axis))
        length = math.ceil(cells) * cell
        ends = [lower, lower + length] if side == "max" else [upper - length, upper]
        case.grid.domain[axis] = ends
        case.grid.note_extension(
            f"grid.domain.{axis} is extended from {_interval(lower, upper)} to {_interval(*ends)} at its "
            f"open face {axis}_{side}: {math.ceil(cells)} whole cells of {cell:g} m"
        )


def _open_side(case: Case, axis: str) -> str | None:
    for side in ("max", "min"):
        at_axis = case.space_.radial and (axis, side) == ("r", "min")
        if not at_axis and case.grid.faces.get(f"{axis}_{side}", "open") == "open":
            return side
    return None


def _misfit(case: Case, axis: str) -> str:
    lower, upper = case.grid.domain[axis]
    cells, cell = cells_along(case, axis), case.grid.cell_size
    fixed = [
        case.grid.domain[other][1] - case.grid.domain[other][0]
        for other in case.space_.axes
        if _open_side(case, other) is None
    ]
    sizes = [f"{size:.9g} m" for size in _nearest_sizes(upper - lower, cells, fixed)]
    fits = f"set grid.cell_size to {' or '.join(sizes)}, or " if sizes else ""
    near = _interval(lower, lower + max(1, round(cells)) * cell)
    return (
        f"grid.domain.{axis} is {cells:.6g} cells long; it must be a whole number of cells of {cell:g} m, "
        f"and it cannot be extended, since neither of its faces is open: {fits}"
        f"set grid.domain.{axis} to {near}"
    )


def _nearest_sizes(length: float, cells: float, lengths: Sequence[float]) -> Iterator[float]:
    """The next smaller and the next larger cell size that divide all lengths, as far as there are any."""
    smaller = range(math.ceil(cells), math.ceil(cells) + MOST_TRIED)
    larger = range(math.floor(cells), max(0, math.floor(cells) - MOST_TRIED), -1)
    for numbers in (smaller, larger):
        for number in numbers:
            size = length / number
            if all(is_whole(other / size) for other in lengths):
                yield size
                break


def _interval(lower: float, upper: float) -> str:
    return f"[{lower:.9g}, {upper:.9g}]"
