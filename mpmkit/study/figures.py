"""Figures of a study: all histories in one chart, and their differences from the first finished member."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure

from ..output.atomic import replacing
from ..report.style import CATEGORIES, DPI, figure_style
from .labels import title_of

SHOWN = {
    "spread_diameter": ("spread diameter (mm)", 1e3),
    "slump": ("slump (mm)", 1e3),
    "height": ("largest height (mm)", 1e3),
    "kinetic_energy": ("kinetic energy (J)", 1.0),
    "max_speed": ("largest speed (m/s)", 1.0),
}
"""Histories that are drawn, with their labels and scales."""
DASHES = ("-", (0, (5, 2)), (0, (1.5, 1.5)), (0, (6, 2, 1.5, 2)))
MOST_NAMED = 24
"""Most members in a legend."""
MOST_BESIDE, LONGEST_BESIDE = 12, 48
"""Most members, and characters of a name, for a legend in an empty place of the grid."""
WIDTH_OF_LEGEND = 120
"""Characters in a row of a legend below the charts."""


def draw(dataset: xarray.Dataset, directory: Path) -> list[Path]:
    """Draw the histories of the members; return the PNG files written."""
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
        yield title_of(member, tuple(map(str, dimensions))), member


def _figure(dataset: xarray.Dataset, differences: bool) -> Figure | None:
    names = [name for name in SHOWN if name in dataset and bool(dataset[name].notnull().any())]
    drawn = [
        (title, member, style)
        for (title, member), style in zip(members(dataset), _styles(dataset.fate.shape), strict=True)
        if any(bool(member[name].notnull().any()) for name in names)
    ]
    of, base = "", None
    if differences:
        base = next((item for item in drawn if str(item[1].fate.item()) == "finished"), None)
        if base is None:
            return None
        drawn.remove(base)
        of = f", less those of {base[0]}"
    if not names or not drawn:
        return None
    rows = (len(names) + 1) // 2
    figure = Figure(figsize=(10.5, 3.4 * rows + 0.6), layout="constrained")
    grid = figure.subplots(rows, 2, squeeze=False)
    for axes, name in zip(grid.flat, names, strict=False):
        label, scale = SHOWN[name]
        for title, member, (colour, dashes) in drawn:
            values = (member[name] - base[1][name] if base else member[name]) * scale
            axes.plot(dataset.time, values, color=colour, linestyle=dashes, label=title)
        axes.set_xlabel("time (s)")
        axes.set_ylabel(f"difference in {label}" if differences else label)
        axes.margins(x=0)
    empty = list(grid.flat)[len(names) :]
    for axes in empty:
        axes.set_axis_off()
    figure.suptitle(f"{dataset.attrs['title']}: histories{of}", x=0.01, ha="left", fontweight="bold")
    handles, labels = grid.flat[0].get_legend_handles_labels()
    if len(labels) <= MOST_NAMED:
        if empty and len(labels) <= MOST_BESIDE and max(map(len, labels)) <= LONGEST_BESIDE:
            empty[0].legend(handles, labels, loc="center left")
        else:
            columns = max(1, min(4, len(labels), WIDTH_OF_LEGEND // (max(map(len, labels)) + 6)))
            figure.legend(handles, labels, loc="outside lower center", ncols=columns)
    return figure


def _styles(shape: tuple[int, ...]) -> list[tuple[str, Any]]:
    """Colour and dashes of each member, from a limited number of distinct colours.

    With more members than colours, colours show one dimension of the grid and dashes the others.
    """
    colours, count = len(CATEGORIES), int(np.prod(shape))
    # Few members also get different dashes, so that two coinciding curves are both visible.
    by_number = [(n % colours, n if count <= colours else n // colours) for n in range(count)]
    fitting = [axis for axis, size in enumerate(shape) if 1 < size <= colours]
    if count > colours and fitting:
        axis = max(fitting, key=lambda axis: shape[axis])
        others = [size for number, size in enumerate(shape) if number != axis]
        if int(np.prod(others)) <= len(DASHES):
            places = list(np.ndindex(shape))
            rest = list(np.ndindex(*others))
            by_number = [(p[axis], rest.index(p[:axis] + p[axis + 1 :])) for p in places]
    return [(CATEGORIES[colour], DASHES[dashes % len(DASHES)]) for colour, dashes in by_number]
