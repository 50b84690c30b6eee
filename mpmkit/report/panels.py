"""A grid of panels with the same limits and equal aspect that fills most of its page."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import MaxNLocator

WIDTH = 9.0
"""Width of the page, inch (narrow panels do not fill it); all lengths here are in inch."""
HEIGHT = 11.0
"""Largest height of the page."""
BETWEEN, AROUND = 0.6, 0.9
"""Space for text at one panel, and at all of them."""
NARROWEST = 1.9
"""Least width for the text above a panel."""
COLUMNS, NARROW_COLUMNS = 3, 4
"""Most panels in a row, so that their titles do not overlap."""
PAD = 0.1
"""Space above and below a panel and its text."""
BAR = 1.0
"""Room for a colour bar at the side."""
NAME, LINE = 1.6, 0.25
"""Room across and along for a name in a legend."""


class Panels:
    """``count`` panels, each to show a width and a height ``extent`` (2,) in the same scale."""

    def __init__(self, count: int, extent: np.ndarray) -> None:
        most = NARROW_COLUMNS if extent[1] > 2 * extent[0] else COLUMNS
        choices = range(1, min(count, most) + 1)
        self._columns = min(choices, key=lambda columns: _badness(count, columns, extent))
        rows = math.ceil(count / self._columns)
        self.figure = Figure(
            figsize=_page(count, self._columns, extent), layout=ConstrainedLayoutEngine(h_pad=PAD)
        )
        grid = self.figure.subplots(rows, self._columns, sharex=True, sharey=True, squeeze=False)
        self.axes: list[Axes] = list(grid.flat[:count])
        self._empty: list[Axes] = list(grid.flat[count:])
        for axes in grid.flat:
            axes.set_aspect("equal")
        for axes in self._empty:
            axes.set_axis_off()

    def title(self, text: str) -> None:
        """Name the picture, at the left as on the other pictures of a report."""
        self.figure.suptitle(text, x=0.01, ha="left", fontweight="bold", fontsize=12)

    def label(self, horizontal: str, vertical: str) -> None:
        """Name the axes along the lower and the left side of the grid."""
        lowest = self.axes[-self._columns :]  # of each column, also where the last row is not full
        for axes in lowest:
            axes.tick_params(labelbottom=True)
            axes.set_xlabel(horizontal)
        for axes in self.axes[:: self._columns]:
            axes.set_ylabel(vertical)

    def legend(self, handles: Sequence[Artist]) -> None:
        """Name lines below all panels; the page grows by the room for it."""
        width, height = self.figure.get_size_inches()
        columns = max(1, int(width / NAME))
        self.figure.set_size_inches(width, height + LINE * math.ceil(len(handles) / columns))
        self.figure.legend(handles=handles, loc="outside lower center", ncols=min(columns, len(handles)))

    def colour_bar(self, mappable: ScalarMappable, label: str, extend: str = "neither") -> None:
        """Put the colour bar into an empty place of the grid, or to the right of it."""
        if self._empty:
            place = self._empty[-1].inset_axes((0.1, 0.5, 0.8, 0.08))
            bar = self.figure.colorbar(
                mappable, cax=place, orientation="horizontal", label=label, extend=extend
            )
            bar.locator = MaxNLocator(nbins=3)
            bar.update_ticks()
        else:
            self.figure.colorbar(mappable, ax=self.axes, label=label, shrink=0.8, aspect=30, extend=extend)


def _page(count: int, columns: int, extent: np.ndarray) -> tuple[float, float]:
    """Width and height of a page with ``columns`` panels in a row."""
    rows, empty = math.ceil(count / columns), -count % columns
    tallest = (HEIGHT - AROUND) / rows - BETWEEN
    width = min(WIDTH / columns - BETWEEN, tallest * extent[0] / extent[1])
    bar = 0.0 if empty else BAR
    return (
        columns * (max(width, NARROWEST) + BETWEEN) + bar,
        AROUND + rows * (width * extent[1] / extent[0] + BETWEEN),
    )


def _badness(count: int, columns: int, extent: np.ndarray) -> float:
    """Difference of a page from 4:3, plus a penalty for each empty place not used by the colour bar."""
    empty = -count % columns
    width, height = _page(count, columns, extent)
    return abs(math.log(width / height / (4 / 3))) + 0.5 * max(empty - 1, 0)
