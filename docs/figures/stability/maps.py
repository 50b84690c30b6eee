"""What the maps of where methods fail share: sheets of panels, colours, and data kept beside the figure."""

import io
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[1]))  # beside this folder lies what all figures share

from common import DOCS
from options import parser, require

sys.path.append(str(DOCS.parent / "tests/validation"))  # scenes whose answers are known are there already

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#767676"
"""Okabe and Ito's palette."""
COLOURS = {"usl": VERMILION, "usf": BLUE, "musl": GREEN}
ORDERS = list(COLOURS)
DPI = 160


def panels(rows: int, columns: int, size: tuple[float, float], **more) -> tuple[Figure, np.ndarray]:
    """A figure of empty panels, ``(rows, columns)``, with a light grid."""
    figure = Figure(figsize=size, dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    found = figure.subplots(rows, columns, squeeze=False, **more)
    for axes in found.flat:
        axes.grid(alpha=0.3)
    return figure, found


def sheet(title: str, count: int, width: float = 9.6, height: float = 4.2) -> tuple[Figure, list[Axes]]:
    """A row of empty panels under one title."""
    figure, row = panels(1, count, (width, height))
    figure.suptitle(title, fontsize=10)
    return figure, list(row[0])


def make(name: str, measure: Callable[[], xarray.Dataset], draw: Callable[[xarray.Dataset], Figure]) -> None:
    """Measure, keep what was found in docs/data, and draw it; with --draw, draw what was kept."""
    data = DOCS / "data" / f"stability_{name}.nc"
    arguments = parser()
    arguments.add_argument("--draw", action="store_true", help="draw what was measured before")
    if arguments.parse_args().draw:
        require([data])
    else:
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
