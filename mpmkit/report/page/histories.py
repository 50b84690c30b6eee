"""Section: the results of the run against time."""

from __future__ import annotations

from typing import Any

import numpy as np

from .section import Section, note
from .section import charts as charts_side_by_side
from .source import Source

ROWS = 800
"""Most rows of a history on a page."""
DIGITS = 7
MM = 1e3

LARGE = 10.0
"""m; larger lengths are drawn in m, smaller ones in mm."""


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
    """Spread (width if the scene is not a slump test) and heights."""
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
    """A sentence if the page does not hold all rows of the history; else an empty string."""
    rows = len(source.results.time)
    return f" The page shows {ROWS} of {rows} rows; history.nc has all." if rows > ROWS else ""


def rows_of(source: Source) -> np.ndarray:
    """The rows that the page holds: all, or evenly spaced ones that include the first and the last."""
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
