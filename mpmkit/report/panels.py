"""A grid of panels of the same limits and of equal aspect that leaves little of its page empty."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

WIDTH = 9.0
"""Width of the page, inch; all lengths here are in inch."""
HEIGHT = 11.0
"""Largest height of the page."""
BETWEEN, AROUND = 0.6, 0.9
"""Room for what is written at one panel, and at all of them."""
COLUMNS = 3
"""Most panels side by side, so that what is written above one keeps clear of the next."""


class Panels:
    """``count`` panels, each to show a width and a height ``extent`` (2,) in the same scale."""

    def __init__(self, count: int, extent: np.ndarray) -> None:
        choices = range(1, min(count, COLUMNS) + 1)
        self._columns = min(choices, key=lambda columns: _badness(count, columns, extent))
        rows = math.ceil(count / self._columns)
        height = min(_page_height(count, self._columns, extent), HEIGHT)
        self.figure = Figure(figsize=(WIDTH, height), layout="constrained")
        grid = self.figure.subplots(rows, self._columns, sharex=True, sharey=True, squeeze=False)
        self.axes: list[Axes] = list(grid.flat[:count])
        self._empty: list[Axes] = list(grid.flat[count:])
        for axes in grid.flat:
            axes.set_aspect("equal")
        for axes in self._empty:
            axes.set_axis_off()

    def label(self, horizontal: str, vertical: str) -> None:
        """Name the axes along the lower and the left side of the grid."""
        for axes in self.axes[
            -self._columns :
        ]:  # the lowest of each column, also where the last row is not full
            axes.tick_params(labelbottom=True)
            axes.set_xlabel(horizontal)
        for axes in self.axes[:: self._columns]:
            axes.set_ylabel(vertical)

    def colour_bar(self, mappable: ScalarMappable, label: str) -> None:
        """Put the colour bar into an empty place of the grid, or to the right of it."""
        if self._empty:
            place = self._empty[-1].inset_axes((0.1, 0.5, 0.8, 0.08))
            self.figure.colorbar(mappable, cax=place, orientation="horizontal", label=label)
        else:
            self.figure.colorbar(mappable, ax=self.axes, label=label, shrink=0.8, aspect=30)


def _page_height(count: int, columns: int, extent: np.ndarray) -> float:
    panel_width = WIDTH / columns - BETWEEN
    return AROUND + math.ceil(count / columns) * (panel_width * extent[1] / extent[0] + BETWEEN)


def _badness(count: int, columns: int, extent: np.ndarray) -> float:
    """How far a page is from 4:3, with a price on each empty place but the one that the colour bar takes."""
    empty = -count % columns
    return abs(math.log(WIDTH / _page_height(count, columns, extent) / (4 / 3))) + 0.5 * max(empty - 1, 0)
