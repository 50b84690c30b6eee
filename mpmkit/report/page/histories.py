"""Section: how the figures of the run changed with time."""

from __future__ import annotations

from typing import Any

import numpy as np

from .section import Section, note
from .section import charts as charts_side_by_side
from .source import Source

ROWS = 800
"""Rows of a history that a page holds at the most."""
DIGITS = 7
MM = 1e3

LARGE = 10.0
"""m, from which on lengths are drawn in m."""


def section(source: Source) -> Section | None:
    """Charts with a cursor that reads values."""
    drawn = {"shape": _shape(source), "speed": _speed(source)}
    charts = {name: chart for name, chart in drawn.items() if chart is not None}
    if not charts:
        return None
    body = charts_side_by_side({name: f"{of['title']} against time" for name, of in charts.items()})
    body += note(
        "Move over a chart, or use the arrow keys in it, to read values; click to set the player to that "
        "time. Drag across to enlarge a part, and double-click to see all again." + thinned(source)
    )
    return Section("histories", "Histories", body, {"charts": charts})


def _shape(source: Source) -> dict[str, Any] | None:
    """Spread, or the width of what is no slump test, and heights."""
    wide = source.results.series("spread_diameter")
    large = wide is not None and np.nanmax(wide) >= LARGE
    unit, scale = ("m", 1.0) if large else ("mm", MM)
    across = "width" if source.space.name == "plane-strain" else "spread"
    names = {across: "spread_diameter", "height": "height", "height on the axis": "axis_height"}
    title = f"{across.capitalize()} and height"
    return chart(source, title, unit, {label: (name, scale) for label, name in names.items()})


def _speed(source: Source) -> dict[str, Any] | None:
    return chart(source, "Speed", "m/s", {"largest speed": ("max_speed", 1.0)})


def thinned(source: Source) -> str:
    """A sentence where not all rows of the history are on the page; else nothing."""
    rows = len(source.results.time)
    return f" The page shows {ROWS} of {rows} rows; history.nc has all." if rows > ROWS else ""


def rows_of(source: Source) -> np.ndarray:
    """The rows that the page holds: all, or evenly spread ones with the first and the last."""
    rows = len(source.results.time)
    return np.arange(rows) if rows <= ROWS else np.linspace(0, rows - 1, ROWS).round().astype(int)


def chart(
    source: Source, title: str, unit: str, curves: dict[str, tuple[str, float]]
) -> dict[str, Any] | None:
    """The data of a chart of variables of the history, by the labels of its curves; None if none is there."""
    rows = rows_of(source)
    found = []
    for label, (name, scale) in curves.items():
        values = source.results.series(name)
        if values is not None:
            found.append({"label": label, "values": listed(scale * values[rows])})
    return of_curves(source, title, unit, found)


def of_curves(source: Source, title: str, unit: str, curves: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The data of a chart against the times of ``rows_of``."""
    if not curves or len(source.results.time) < 2:
        return None
    times = listed(source.results.time[rows_of(source)])
    return {"title": title, "unit": unit, "x": times, "xLabel": "time", "xUnit": "s", "curves": curves}


def listed(values: np.ndarray) -> list[float | None]:
    """Numbers for JSON with as many digits as a reader can see; None for what is not a number."""
    return [float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None for value in values.tolist()]
