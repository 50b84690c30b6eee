"""What the maps of volumes and energy share: sheets of panels, colours, and data kept beside the figure."""

import io
import sys
from collections.abc import Callable
from pathlib import Path

import xarray
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[1]))  # beside this folder lies what all figures share

from common import DOCS

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#767676"
"""Okabe and Ito's palette."""
DRAW = "--draw"
DPI = 160


def sheet(title: str, panels: int, width: float = 9.6, height: float = 4.2) -> tuple[Figure, list[Axes]]:
    """A row of empty panels under one title."""
    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(title, fontsize=10)
    row = list(figure.subplots(1, panels, squeeze=False)[0])
    for axes in row:
        axes.grid(alpha=0.3)
    return figure, row


def make(name: str, measure: Callable[[], xarray.Dataset], draw: Callable[[xarray.Dataset], Figure]) -> None:
    """Measure, keep what was found in docs/data, and draw it; with --draw, draw what was kept."""
    data = DOCS / "data" / f"stability_{name}.nc"
    if DRAW not in sys.argv[1:]:
        found = measure()
        packed = {variable: {"zlib": True} for variable in found if found[variable].dtype.kind == "f"}
        found.to_netcdf(data, encoding=packed)
    with xarray.open_dataset(data) as kept:
        figure = draw(kept.load())
    drawn = io.BytesIO()
    figure.savefig(drawn)
    # Few colours make a small file, and these figures have few.
    small = Image.open(drawn).convert("RGB").quantize(64)
    small.save(DOCS / "images" / "stability" / f"{name}.png", optimize=True, dpi=(DPI, DPI))
