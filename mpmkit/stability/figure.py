"""Figure: the largest stable step of every combination, and the largest step that its schemes use."""

from __future__ import annotations

import math
from pathlib import Path

from matplotlib.figure import Figure

from ..output.atomic import cannot_write, replacing
from ..report.style import BLUE, DPI, GREY, VERMILION, figure_style

BREAKS = {"guard": "X", "energy": "^", "momentum": "s", "distance": "D"}
"""Marker of the smallest unstable step, by the violated criterion."""
WRONG = {
    "guard": "stopped by a guard",
    "energy": "creates energy",
    "momentum": "creates momentum",
    "distance": "leads elsewhere",
}


def picture_in(directory: Path) -> Path:
    """Path of the map in a directory."""
    return directory / "stability.png"


def draw(rows: list[dict], kinds: list[str], title: str, directory: Path) -> Path:
    """Draw the map into ``stability.png`` of a directory, which is made; returns its path."""
    path = picture_in(directory)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(directory, error) from error
    with figure_style():
        figure = Figure(figsize=(8.4, 1.6 + 0.34 * len(rows)), layout="constrained")
        axes = figure.add_subplot()
        axes.set_xscale("log")
        places = range(len(rows), 0, -1)
        for place, row in zip(places, rows, strict=True):
            axes.plot([0.04, row["fraction"]], [place, place], color=BLUE, linewidth=5, solid_capstyle="butt")
            if row["unstable"] != math.inf:
                marker = BREAKS[row["broken"]]
                axes.plot(
                    row["unstable"], place, marker=marker, color=VERMILION, linestyle="none", markersize=7
                )
            axes.plot([row["declared"]] * 2, [place - 0.4, place + 0.4], color="black", linewidth=1.6)
        names = [", ".join(row[kind] for kind in kinds) or title for row in rows]
        axes.set_yticks(
            list(places), [f"{name} ({row['limit']})" for name, row in zip(names, rows, strict=True)]
        )
        axes.set_xlim(0.04, 2.6)
        axes.set_xticks([0.05, 0.1, 0.2, 0.5, 1, 2], ["0.05", "0.1", "0.2", "0.5", "1", "2"])
        axes.minorticks_off()
        axes.set_xlabel("time step over the limit in brackets")
        axes.set_title(f"{title}: largest stable step", loc="left")
        axes.plot([], [], color=BLUE, linewidth=5, label="stable")
        axes.plot([], [], color="black", linewidth=1.6, label="largest step that the schemes use")
        for name, marker in BREAKS.items():
            if any(row["broken"] == name for row in rows):
                axes.plot([], [], marker=marker, color=VERMILION, linestyle="none", label=WRONG[name])
        axes.axvline(1.0, color=GREY, linewidth=1, linestyle=":")
        figure.legend(loc="outside lower center", ncols=3)
        with replacing(path) as partial:
            figure.savefig(partial, format="png", dpi=DPI, bbox_inches="tight", pad_inches=0.12)
    return path
