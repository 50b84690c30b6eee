"""What the figures of the docs share."""

import csv
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

DOCS = Path(__file__).parents[1]
REFERENCE = DOCS.parent / "tests/validation/reference/slump_free_slip_herschel_bulkley.csv"


def figure(title: str) -> tuple[Figure, Axes]:
    """An empty plot of spread against the first second."""
    sheet = Figure(figsize=(6.4, 4), dpi=160, layout="constrained")
    FigureCanvasAgg(sheet)
    axes = sheet.add_subplot()
    axes.set(xlim=(0, 1), ylim=(180, 580), xlabel="time / s", ylabel="spread diameter / mm")
    axes.set_title(title, fontsize=10)
    axes.grid(alpha=0.3)
    return sheet, axes


def plot_reference(axes: Axes) -> None:
    """The independent incompressible finite-element solution."""
    with REFERENCE.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    time, spread = ([float(row[name]) for row in rows] for name in ("time_s", "spread_diameter_m"))
    axes.plot(time, np.multiply(spread, 1e3), "k--", label="incompressible finite elements")
