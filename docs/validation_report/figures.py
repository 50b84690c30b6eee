"""A figure for every set of curves that the tests recorded."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from mpmkit.report.style import BLACK, BLUE, DPI, GREEN, ORANGE, VERMILION, figure_style, line_chart

from .records import Sheet

COLOURS = (BLUE, VERMILION, GREEN, ORANGE, "#CC79A7", "#56B4E9", "#767676")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
REFERENCE_LINES = ("-", "--", ":", "-.")
FEW, MANY = 12, 300  # points: a line with few of them shows each, a cloud of many has small ones
Drawn = tuple[int, str, str, str]


def gather(sheets: list[Sheet]) -> dict[str, dict[str, Any]]:
    """Curves by the name of their figure; tests that name the same one add to it."""
    found: dict[str, dict[str, Any]] = {}
    for sheet in sheets:
        for curves in sheet["curves"]:
            figure = found.setdefault(curves["name"], curves | {"series": []})
            known = [one["label"] for one in figure["series"]]
            figure["series"] += [one for one in curves["series"] if one["label"] not in known]
    return {name: figure for name, figure in found.items() if figure["series"]}


def draw(sheets: list[Sheet], folder: Path) -> list[Drawn]:
    """Write the figures, remove those that nothing stands behind any more; says what there is to show."""
    figures = gather(sheets)
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.glob("*.png"):
        if path.stem not in figures:
            path.unlink()
    with figure_style():
        for figure in figures.values():
            _draw(figure, folder / f"{figure['name']}.png")
    return [(f["section"], f["name"], f["title"], f["caption"]) for f in figures.values()]


def _draw(figure: dict[str, Any], path: Path) -> None:
    sheet, axes = line_chart(figure["title"], figure["y"])
    axes.set_xlabel(figure["x"])
    axes.margins(x=0.02)
    if figure["scale"] == "log-log":
        _take_logarithms(axes, figure["series"])
    told = [one for one in figure["series"] if one["style"] in ("reference", "measured")]
    found = [one for one in figure["series"] if one["style"] not in ("reference", "measured")]
    for number, one in enumerate(told):
        _plot(axes, one, BLACK, "s", REFERENCE_LINES[number % len(REFERENCE_LINES)], 1.3)
    for number, one in enumerate(found):
        colour, marker = COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]
        _plot(axes, one, colour, marker, ("-", "--")[number % 2], 1.9)
    sheet.legend(loc="outside lower center", ncols=2, fontsize=9)
    sheet.savefig(path, dpi=DPI)


def _plot(axes: Axes, one: dict[str, Any], colour: str, marker: str, line: str, width: float) -> None:
    points = one["style"] in ("points", "measured")
    axes.plot(
        one["x"],
        one["y"],
        color=colour,
        linestyle="none" if points else line,
        linewidth=width,
        marker=marker if points or (one["style"] == "line" and len(one["x"]) < FEW) else None,
        markersize=2.5 if len(one["x"]) > MANY else 5,
        markerfacecolor=colour if one["style"] == "measured" else "none",
        label=one["label"],
    )


def _take_logarithms(axes: Axes, series: list[dict[str, Any]]) -> None:
    """Logarithmic axes with plain numbers; where every x is one of a few, those are the ticks."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    values = sorted({x for one in series for x in one["x"]})
    if len(values) < FEW:
        axes.set_xticks(values)
        axes.xaxis.set_minor_locator(NullLocator())
