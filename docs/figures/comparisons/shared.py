"""What the figures of the comparisons share: the data of a study, and how a figure looks.

A figure is drawn from docs/data/NAME.nc. Unless a script is given --draw, it first makes that file from
runs/NAME/results.nc, which `mpmkit study cases/studies/NAME.json` leaves behind.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[1]))  # beside this folder lies what all figures share

from options import parser, require

DOCS = Path(__file__).parents[2]
REFERENCE = DOCS.parent / "tests/validation/reference/slump_free_slip_herschel_bulkley.csv"
BLUE, ORANGE, GREEN, RED, SKY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9"
"""Okabe & Ito's colours, which those see apart too who are blind to some."""
ORDERS = {"USL": {"color": BLUE}, "USF": {"color": RED, "ls": "--"}, "MUSL": {"color": GREEN, "ls": ":"}}
"""How the update orders are drawn."""
SHAPES = {"cpGIMP": {"color": BLUE}, "linear": {"color": RED}}
"""How the shape functions are drawn."""


def data(**kept: Sequence[str]) -> list[xarray.Dataset]:
    """The studies named, each with the variables, ``kept``, that the figure needs of it."""
    arguments = parser()
    arguments.add_argument("--draw", action="store_true", help="from docs/data, without the studies' runs")
    if arguments.parse_args().draw:
        require(DOCS / "data" / f"{study}.nc" for study in kept)
    else:
        require(DOCS.parent / "runs" / study / "results.nc" for study in kept)
        for study, variables in kept.items():
            _keep(study, variables)
    return [xarray.load_dataset(DOCS / "data" / f"{study}.nc") for study in kept]


def _keep(study: str, variables: Sequence[str]) -> None:
    with xarray.open_dataset(DOCS.parent / "runs" / study / "results.nc") as results:
        few = results[[*variables, "fate", "simulated_time", "cpu_seconds", "steps"]]
        few.attrs.pop("study")  # it is the study file
        packed = {
            name: {"dtype": "float32", "zlib": True} for name in few.data_vars if few[name].dtype.kind == "f"
        }
        few.to_netcdf(DOCS / "data" / f"{study}.nc", encoding=packed)


def panels(columns: int, title: str, rows: int = 1) -> tuple[Figure, list[Axes]]:
    """A sheet of plots, in the order in which one reads."""
    sheet = Figure(figsize=(3.3 * columns, 3.6 if rows == 1 else 3.2 * rows), dpi=160, layout="constrained")
    FigureCanvasAgg(sheet)
    plots = list(sheet.subplots(rows, columns, squeeze=False).flat)
    for plot in plots:
        plot.grid(alpha=0.3)
    sheet.suptitle(title, fontsize=11)
    return sheet, plots


def say(plot: Axes, title: str, x: str, y: str) -> None:
    """Title and axes of one plot."""
    plot.set_title(title, fontsize=9)
    plot.set_xlabel(x, fontsize=9)
    plot.set_ylabel(y, fontsize=9)
    plot.tick_params(labelsize=8)


def save(sheet: Figure, name: str) -> None:
    """Write docs/images/comparisons/NAME.png, with as few colours as the lines need."""
    sheet.canvas.draw()
    image = Image.fromarray(np.asarray(sheet.canvas.buffer_rgba())).convert("RGB").quantize(256)
    image.save(DOCS / "images" / "comparisons" / f"{name}.png", optimize=True)


def reference() -> tuple[np.ndarray, np.ndarray]:
    """Time, s, and spread, m, of the independent incompressible finite-element solution of slump.json."""
    lines = [line for line in REFERENCE.read_text().splitlines() if not line.startswith("#")]
    time, spread, _ = np.loadtxt(lines[1:], delimiter=",", unpack=True)
    return time, spread
