"""Figure: error against cost on logarithmic axes, with the Pareto front."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from ..output.atomic import replacing
from ..report.style import BLUE, DPI, GREY, VERMILION, figure_style
from .chart import Chart
from .quantities import COSTS

MANY_DECADES, FEW_DECADES = 1e3, 10.0
"""If the ratio of the ends of an axis is larger, its ticks are powers of ten, or 1, 2 and 5 times these."""
LEAST_ERROR = 1e-6
"""Smaller errors are drawn at this value: a logarithmic axis has no place for 0."""


def draw(chart: Chart, title: str, path: Path) -> None:
    """Draw a chart into a PNG file."""
    with figure_style():
        figure = Figure(figsize=(10.5, 6.4), layout="constrained")
        axes = figure.add_subplot()
        axes.set_xscale("log")
        axes.set_yscale("log")
        front = chart.front
        others = [point for point in chart.points if point not in front]
        for points, colour, size in ((others, GREY, 5), (front, BLUE, 8)):
            axes.plot(
                [point.cost for point in points],
                [max(point.error, LEAST_ERROR) for point in points],
                "o",
                color=colour,
                markersize=size,
                markeredgecolor="white",
                linestyle="none",
            )
        axes.step(
            [point.cost for point in front],
            [max(point.error, LEAST_ERROR) for point in front],
            where="post",
            color=VERMILION,
            linewidth=1.2,
            linestyle="--",
            label="Pareto's front",
            zorder=0,
        )
        for number, point in enumerate(front, start=1):
            axes.annotate(
                str(number),
                (point.cost, max(point.error, LEAST_ERROR)),
                xytext=(6, 5),
                textcoords="offset points",
                color=BLUE,
                fontweight="bold",
            )
        _number_ticks(axes)
        units, text = COSTS[chart.cost]
        axes.set_xlabel(f"{text} ({units})" if units != "1" else text)
        axes.set_ylabel(f"error of {chart.variable.replace('_', ' ')},\nrelative to {chart.against}")
        axes.set_title(f"{title}: accuracy against cost", loc="left")
        names = "\n".join(f"{number}  {point.title}" for number, point in enumerate(front, start=1))
        figure.text(1.01, 0.97, names, va="top", ha="left", fontsize=9, color=BLUE)
        axes.legend(loc="best")
        with replacing(path) as partial:
            figure.savefig(partial, format="png", dpi=DPI, bbox_inches="tight", pad_inches=0.12)


def _number_ticks(axes: Axes) -> None:
    """Tick labels that all differ: powers of ten over several decades, more ticks over a shorter range."""
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        if high > MANY_DECADES * low:
            axis.set_major_locator(LogLocator())
        elif high > FEW_DECADES * low:
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        else:
            axis.set_major_locator(MaxNLocator(5))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))
        axis.set_minor_formatter(NullFormatter())
