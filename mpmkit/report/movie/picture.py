"""The parts that every picture of a movie has: its size, its title, the scale of its colours."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from .quantities import Quantity, Scale

WIDTH, TALLEST = 7.2, 7.2
"""Of a picture, inch."""
DPI = 100
ABOUT = np.array([1.1, 1.25])
"""Space beside the drawing for text, inch."""


def empty_picture(extent: np.ndarray) -> tuple[Figure, Axes]:
    """A figure for a drawing of a width and a height ``extent`` in the same scale.

    The layout is the same for all pictures; otherwise the drawing would jump from picture to picture.
    """
    width = WIDTH - ABOUT[0]
    height = width * extent[1] / extent[0]
    if height > TALLEST - ABOUT[1]:
        height = TALLEST - ABOUT[1]
    size = np.array([width, height]) + ABOUT
    figure = Figure(figsize=tuple(size))
    axes = figure.add_axes((0.8 / size[0], 0.55 / size[1], width / size[0], height / size[1]))
    axes.set_aspect("equal")
    return figure, axes


def add_title(figure: Figure, text: str, time: str) -> None:
    """Write the name of the run at the left and the time at the right."""
    top = 1 - 0.18 / figure.get_size_inches()[1]
    figure.text(0.02, top, text, ha="left", va="center", fontweight="bold", fontsize=11)
    figure.text(0.98, top, time, ha="right", va="center", fontsize=11, family="monospace")


def add_scale(figure: Figure, quantity: Quantity, scale: Scale) -> None:
    """The scale of the colours, below the title."""
    width, height = figure.get_size_inches()
    place = figure.add_axes((0.8 / width, 1 - 0.46 / height, 0.45 * (width - 1) / width, 0.1 / height))
    mappable = ScalarMappable(norm=scale.norm, cmap=scale.colour_map)
    bar = figure.colorbar(mappable, cax=place, orientation="horizontal", extend=scale.extend)
    place.tick_params(labelsize=8, length=2)
    if quantity.ticks:
        bar.set_ticks(range(len(quantity.ticks)), labels=list(quantity.ticks))
        place.tick_params(length=0)
    else:
        side = 0.8 + 0.45 * (width - 1) + 0.15
        figure.text(side / width, 1 - 0.41 / height, quantity.label, ha="left", va="center", fontsize=9)


def pixels(figure: Figure) -> np.ndarray:
    """The figure as RGB bytes, (height, width, 3)."""
    figure.set_dpi(DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
