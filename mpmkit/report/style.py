"""The common style of the pictures."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

DPI = 160
MILLIMETRES = 1e3  # in a metre

# Okabe and Ito's palette: colour-blind readers can distinguish it
BLACK, ORANGE, GREEN, BLUE, VERMILION = "#000000", "#E69F00", "#009E73", "#0072B2", "#D55E00"
GREY = "#767676"
SKY, PINK = "#56B4E9", "#CC79A7"
CATEGORIES = (BLUE, VERMILION, GREEN, ORANGE, BLACK, SKY, PINK, GREY)
"""Colours of curves that have no order."""
COLOUR_MAP = "viridis"
WALL_COLOURS = (VERMILION, PINK, ORANGE, BLACK, GREY)
"""Colours of walls, none of which is in the colour map."""
FACE_COLOURS = (BLUE, GREEN, SKY)
"""Colours of faces of the grid beside them."""

_STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.size": 10,
    "axes.titlesize": 12,
    "axes.titleweight": "bold",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E4E4E4",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.9,
    "legend.frameon": False,
    "text.parse_math": False,  # a case's name may hold a dollar sign
}


@contextmanager
def figure_style() -> Iterator[None]:
    """Draw and save figures in this style inside the block; matplotlib's settings are restored after it."""
    with matplotlib.rc_context(_STYLE):
        yield


def line_chart(title: str, ylabel: str) -> tuple[Figure, Axes]:
    """A figure with one chart against time."""
    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axes = figure.add_subplot()
    axes.set_title(title, loc="left")
    axes.set_xlabel("time (s)")
    axes.set_ylabel(ylabel)
    axes.margins(x=0)
    return figure, axes
