"""Figures of a study: histories over each other, and their differences from the first."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray
from matplotlib import colormaps
from matplotlib.figure import Figure

from ..output.atomic import replacing
from ..report.style import COLOUR_MAP, DPI, figure_style

SHOWN = {
    "spread_diameter": ("spread diameter (mm)", 1e3),
    "height": ("largest height (mm)", 1e3),
    "kinetic_energy": ("kinetic energy (J)", 1.0),
    "max_speed": ("largest speed (m/s)", 1.0),
}
"""Histories that are drawn, with their labels and scales."""
DASHES = ("-", (0, (5, 2)), (0, (1.5, 1.5)), (0, (6, 2, 1.5, 2)))
MOST_NAMED = 24
"""Members that a legend can name."""


def draw(dataset: xarray.Dataset, directory: Path) -> list[Path]:
    """Draw what the members' histories hold; returns the PNG files written."""
    written = []
    with figure_style():
        for name, differences in (("histories", False), ("differences", True)):
            figure = _figure(dataset, differences)
            if figure is None:
                continue
            path = directory / f"{name}.png"
            with replacing(path) as partial:
                figure.savefig(partial, format="png", dpi=DPI, bbox_inches="tight", pad_inches=0.12)
            written.append(path)
    return written


def members(dataset: xarray.Dataset) -> Iterator[tuple[str, xarray.Dataset]]:
    """Title and data of every member."""
    dimensions = dataset.fate.dims
    for place in np.ndindex(dataset.fate.shape):
        member = dataset.isel(dict(zip(dimensions, place, strict=True)))
        title = ", ".join(str(member[name].item()) for name in dimensions)
        yield title, member


def _figure(dataset: xarray.Dataset, differences: bool) -> Figure | None:
    names = [name for name in SHOWN if name in dataset and bool(dataset[name].notnull().any())]
    drawn = [
        (title, member)
        for title, member in members(dataset)
        if any(bool(member[name].notnull().any()) for name in names)
    ]
    if not names or len(drawn) < 1 + differences:
        return None
    rows = (len(names) + 1) // 2
    figure = Figure(figsize=(10.5, 3.4 * rows + 0.6), layout="constrained")
    grid = figure.subplots(rows, 2, squeeze=False)
    colours = colormaps[COLOUR_MAP](np.linspace(0, 0.92, max(len(drawn), 2)))
    first = drawn[0][1]
    for axes, name in zip(grid.flat, names, strict=False):
        label, scale = SHOWN[name]
        for number, (title, member) in enumerate(drawn[differences:], start=int(differences)):
            values = (member[name] - first[name] if differences else member[name]) * scale
            axes.plot(
                dataset.time,
                values,
                color=colours[number],
                linestyle=DASHES[number % len(DASHES)],
                label=title,
            )
        axes.set_xlabel("time (s)")
        axes.set_ylabel(f"difference in {label}" if differences else label)
        axes.margins(x=0)
    for axes in list(grid.flat)[len(names) :]:
        axes.set_visible(False)
    of = f", less those of {drawn[0][0]}" if differences else ""
    figure.suptitle(f"{dataset.attrs['title']}: histories{of}", x=0.01, ha="left", fontweight="bold")
    handles, labels = grid.flat[0].get_legend_handles_labels()
    if len(labels) <= MOST_NAMED:
        figure.legend(handles, labels, loc="outside lower center", ncols=min(4, len(labels)))
    return figure
