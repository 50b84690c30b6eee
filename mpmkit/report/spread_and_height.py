"""Picture: spread diameter and height against time, with T500."""

from __future__ import annotations

from matplotlib.figure import Figure

from ..output.summary import T500_DIAMETER, lifted_later
from .run_results import RunResults
from .style import BLUE, GREEN, GREY, MILLIMETRES, VERMILION, line_chart

CURVES = {
    "spread_diameter": ("spread diameter", BLUE, "-"),
    "height": ("height, largest", VERMILION, "-"),
    "axis_height": ("height, on the axis", GREEN, (0, (4, 2))),
}


def draw(results: RunResults) -> Figure | None:
    """The lengths that the run recorded, mm."""
    curves = {name: values for name in CURVES if (values := results.series(name)) is not None}
    if not curves:
        return None
    figure, axes = line_chart(f"{results.title}: spread and height", "length (mm)")
    for name, values in curves.items():
        label, colour, dashes = CURVES[name]
        axes.plot(results.time, values * MILLIMETRES, color=colour, linestyle=dashes, label=label)
    axes.set_ylim(0, 1.05 * axes.dataLim.y1)
    t500 = results.summary.get("t500")
    if t500 is not None:
        level = T500_DIAMETER * MILLIMETRES
        axes.axhline(level, color=GREY, linewidth=1, linestyle=":", label=f"{level:.0f} mm")
        axes.axvline(t500, color=GREY, linewidth=1.2, linestyle="--")
        axes.plot([t500], [level], marker="o", markersize=6, color=BLUE, markeredgecolor="white")
        # Half of the height is free of both curves: the spread is above it, the height below.
        right = t500 < 0.7 * results.time[-1]
        said = f"T500 = {t500:.3g} s"
        if lifted_later(results.summary):
            said += f"\n{results.summary['t500_from_lift']:.3g} s from the lift"
        axes.annotate(
            said,
            (t500, level / 2),
            xytext=(6 if right else -6, 0),
            textcoords="offset points",
            ha="left" if right else "right",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
        )
    figure.legend(loc="outside lower center", ncols=4)
    return figure
