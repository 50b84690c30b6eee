"""Rows of the lattice along one axis, cut at the ends of the body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

WIDEST = 1.5
"""Largest width of a row, in spacings, if there are several in a cell."""


@dataclass(frozen=True)
class Rows:
    """Intervals side by side along an axis.

    Attributes:
        centre: m, (n,).
        width: m, (n,).
        kept: whether each is in the part of the body that is kept, (n,).
    """

    centre: np.ndarray
    width: np.ndarray
    kept: np.ndarray


def rows(
    cuts: Sequence[float], kept: int, *, origin: float, cell_size: float, per_cell: int, near: float
) -> Rows:
    """Rows that tile the intervals between neighbouring cuts, without gap or overlap.

    They are those of the lattice, [origin + i s, origin + (i + 1) s]. A row that is cut by an end of an
    interval is combined with its neighbour: they become one row if it is at most 3/2 s wide, else two equal
    rows. So rows are 3/4 s to 3/2 s wide, and none is very thin: thin boxes would make the nodes at the
    surface stiff. With one row in a cell they are s/2 to s wide, because no box may be wider than a cell. An
    interval thinner than s is one row. A cut within ``near`` of a lattice plane counts as on it, and uncut
    rows are exactly those of the lattice.

    Args:
        cuts: m, in rising order: the ends of the body and the planes between them that divide it.
        kept: index of the interval that is kept.
        origin: a lattice plane, m.
        cell_size: Δx, m.
        per_cell: m, rows in a cell, so that s = Δx/m.
        near: m.
    """
    spacing, widest = cell_size / per_cell, min(WIDEST, per_cell)
    places = (np.asarray(cuts) - origin) / spacing
    on_plane = np.abs(places - np.round(places)) <= near / spacing
    places[on_plane] = np.round(places[on_plane])
    parts = [
        _interval(places[i], places[i + 1], cuts[i], cuts[i + 1], origin, spacing, widest)
        for i in range(len(cuts) - 1)
    ]
    return Rows(
        np.concatenate([centre for centre, _ in parts]),
        np.concatenate([width for _, width in parts]),
        np.repeat(np.arange(len(parts)) == kept, [len(centre) for centre, _ in parts]),
    )


def _interval(
    low: float, high: float, start: float, end: float, origin: float, spacing: float, widest: float
) -> tuple[np.ndarray, np.ndarray]:
    """Centres and widths, m, of the rows of [start, end], m, which is [low, high] in spacings."""
    planes = np.arange(np.floor(low) + 1, np.ceil(high))
    if low != np.round(low):
        planes = planes[1:]
    if high != np.round(high):
        planes = planes[:-1]
    edges = np.array([low, *planes, high])
    count = np.ceil(np.diff(edges) / widest - 1e-9).astype(np.int64)  # more than 1 only beside a cut
    whole = (np.floor(edges[:-1]) == edges[:-1]) & (np.diff(edges) == 1)
    places = np.array([start, *(origin + planes * spacing), end])
    width = np.repeat(np.diff(places) / count, count)
    step = np.arange(len(width)) - np.repeat(np.cumsum(count) - count, count)
    centre = np.repeat(places[:-1], count) + (step + 0.5) * width
    first = np.repeat(edges[:-1], count)
    whole = np.repeat(whole, count)
    centre[whole] = origin + (first[whole] + 0.5) * spacing
    width[whole] = spacing
    return centre, width
