"""A figure for every set of curves that the tests recorded."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mpmkit.report.style import BLACK, BLUE, DPI, GREEN, ORANGE, VERMILION, figure_style, line_chart

from .records import Sheet

COLOURS = (BLUE, VERMILION, GREEN, ORANGE, "#CC79A7", "#56B4E9", "#767676")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
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
    if figure["scale"] in ("log", "log-log"):
        axes.set_yscale("log")
    if figure["scale"] == "log-log":
        axes.set_xscale("log")
    axes.margins(x=0.02)
    references = [one for one in figure["series"] if one["style"] == "reference"]
    others = [one for one in figure["series"] if one["style"] != "reference"]
    for number, one in enumerate(references):
        style = ("-", "--", ":", "-.")[number % 4]
        axes.plot(one["x"], one["y"], color=BLACK, linestyle=style, linewidth=1.3, label=one["label"])
    for number, one in enumerate(others):
        colour, marker = COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]
        if one["style"] == "points":
            axes.plot(
                one["x"], one["y"], marker, color=colour, markersize=4.5, markerfacecolor="none",
                label=one["label"],
            )  # fmt: skip
        else:
            axes.plot(one["x"], one["y"], color=colour, label=one["label"])
    axes.legend(fontsize=9)
    sheet.savefig(path, dpi=DPI)
