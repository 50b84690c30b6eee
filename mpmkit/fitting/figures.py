"""Figures of a fit: fitted and measured values, the misfit, and the flow curve with its band."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from ..output.atomic import replacing
from ..report.style import BLACK, BLUE, COLOUR_MAP, DPI, GREY, MILLIMETRES, VERMILION, figure_style
from .measurements import Measured
from .profiles import critical
from .region import region
from .result import FitResult
from .runs import Test

PLACES = 121
"""Places along each axis of a map of the misfit."""
MARGIN = 1.6
"""Size of a map, in widths of the intervals."""


def draw(result: FitResult, directory: Path) -> list[Path]:
    """Draw the figures; return the PNG files written."""
    pictures: dict[str, Callable[[FitResult], Figure | None]] = {
        "fitted": _fitted,
        "misfit": _misfit,
        "flow_curve": _flow_curve,
    }
    written = []
    for name, picture in pictures.items():
        with figure_style():
            figure = picture(result)
            if figure is None:
                continue
            path = directory / f"{name}.png"
            with replacing(path) as partial:
                figure.savefig(partial, format="png", dpi=DPI)
        written.append(path)
    return written


def _fitted(result: FitResult) -> Figure:
    """Each curve with the fitted one, and all single numbers in one chart."""
    solution = result.solution
    band = solution.survey.likelihood.surrogate(region(solution, result.fit.level))
    low, high = band.min(axis=0), band.max(axis=0)
    curves: list[tuple[Test, Measured, slice]] = []
    numbers: list[tuple[Test, Measured, int]] = []
    start = 0
    for test in solution.runs.tests:
        for one in test.measured:
            rows = slice(start, start + len(one.value))
            start = rows.stop
            if one.is_curve:
                curves.append((test, one, rows))
            else:
                numbers.append((test, one, rows.start))
    heights = [4.2] * len(curves) + ([1.2 + 0.6 * len(numbers)] if numbers else [])
    figure = Figure(figsize=(7.2, sum(heights)), layout="constrained")
    panels = list(np.atleast_1d(figure.subplots(len(heights), 1, height_ratios=heights)))
    for axes, (test, one, rows) in zip(panels, curves, strict=False):
        scale, unit = (MILLIMETRES, "mm") if one.quantity.unit == "m" else (1.0, one.quantity.unit)
        axes.errorbar(
            one.time,
            scale * one.value,
            scale * one.uncertainty,
            fmt="o",
            color=GREY,
            markersize=3,
            elinewidth=0.8,
            label="measured",
        )
        axes.fill_between(
            one.time, scale * low[rows], scale * high[rows], color=BLUE, alpha=0.25, linewidth=0
        )
        axes.plot(one.time, scale * solution.fitted[rows], color=BLUE, label="fitted")
        axes.set_title(f"{test.name}: {one.quantity.words}", loc="left")
        axes.set_xlabel("time (s)")
        axes.set_ylabel(f"{one.quantity.variable.replace('_', ' ')} ({unit})")
        axes.legend(loc="best")
    if numbers:
        _numbers(panels[-1], result, numbers)
    return figure


def _numbers(axes: Axes, result: FitResult, numbers: list[tuple[Test, Measured, int]]) -> None:
    """Single numbers: (fitted - measured) / uncertainty."""
    solution, several = result.solution, len(result.solution.runs.tests) > 1
    total = solution.survey.likelihood.misfit.total
    labels = []
    for place, (test, one, row) in enumerate(numbers):
        off = (solution.fitted[row] - one.value[0]) / total[row]
        axes.plot([off], [place], "o", color=BLUE)
        name = f"{test.name}: {one.quantity.words}" if several else one.quantity.words
        labels.append(f"{name}\n{one.value[0]:.4g} {one.quantity.unit}, fitted {solution.fitted[row]:.4g}")
    axes.axvspan(-1, 1, color=GREY, alpha=0.2, linewidth=0)
    axes.axvline(0, color=GREY, linewidth=1)
    axes.set_yticks(range(len(labels)), labels)
    axes.set_ylim(len(labels) - 0.5, -0.5)
    reach = max(3.0, 1.1 * float(np.abs(axes.get_xlim()).max()))
    axes.set_xlim(-reach, reach)
    axes.set_xlabel("(fitted − measured) / uncertainty")
    axes.set_title("single numbers", loc="left")


def _misfit(result: FitResult) -> Figure:
    """A map of Δχ² over the two most uncertain parameters, or the profile of a single parameter."""
    if len(result.parameters) == 1:
        return _profile(result)
    solution = result.solution
    survey, coordinates, names = solution.survey, solution.coordinates, result.names
    width = [interval.high - interval.low for interval in survey.intervals]
    i, j = sorted(np.argsort(width)[-2:].tolist())
    sides = []
    for index in (i, j):
        interval = survey.intervals[index]
        reach = MARGIN * max(interval.high - interval.low, 0.02) / 2
        middle = (interval.high + interval.low) / 2
        sides.append(np.linspace(max(0.0, middle - reach), min(1.0, middle + reach), PLACES))
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1)
    points = np.repeat(np.repeat(survey.best[None, None], PLACES, axis=0), PLACES, axis=1)
    points[..., i], points[..., j] = grid[..., 0], grid[..., 1]
    excess = np.maximum(survey.likelihood.chi2(points) - survey.chi2, 0.0)
    values = [[coordinates.value(index, u) for u in side] for index, side in zip((i, j), sides, strict=True)]
    figure = Figure(figsize=(7.2, 5.2), layout="constrained")
    axes = figure.add_subplot()
    crit = critical(result.fit.level) * survey.widened
    levels = np.linspace(0, 4 * np.sqrt(crit), 13)
    filled = axes.contourf(*values, np.sqrt(excess).T, levels=levels, cmap=f"{COLOUR_MAP}_r", extend="max")
    figure.colorbar(filled, ax=axes, label="√Δχ²", format="%.1f")
    axes.contour(*values, excess.T, levels=[crit], colors=[VERMILION], linewidths=[1.8])
    for point in solution.runs.points:
        if point.stage == solution.stage:
            at = list(point.values.values())
            axes.plot(at[i], at[j], ".", color=BLACK, markersize=4)
    best = list(solution.values.values())
    axes.plot(best[i], best[j], "*", color=VERMILION, markersize=13, markeredgecolor="white")
    for index, axis, side in ((i, axes.xaxis, values[0]), (j, axes.yaxis, values[1])):
        if coordinates.parameters[index].scale == "log" and side[-1] > 3 * side[0]:
            (axes.set_xscale if index == i else axes.set_yscale)("log")
            _plain_numbers(axis)
    axes.set_xlim(values[0][0], values[0][-1])
    axes.set_ylim(values[1][0], values[1][-1])
    axes.set_xlabel(names.label(coordinates.paths[i]))
    axes.set_ylabel(names.label(coordinates.paths[j]))
    axes.grid(False)
    others = "" if len(best) == 2 else ", other parameters at their best values"
    axes.set_title(f"misfit, and region that fits at {100 * result.fit.level:g} %{others}", loc="left")
    return figure


def _profile(result: FitResult) -> Figure:
    solution = result.solution
    interval, path = solution.survey.intervals[0], solution.coordinates.paths[0]
    crit = critical(result.fit.level) * solution.survey.widened
    shown = _around(interval.place, interval.excess < 6 * crit, interval.best)
    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axes = figure.add_subplot()
    values = np.array([solution.coordinates.value(0, u) for u in interval.place])
    axes.plot(values[shown], interval.excess[shown], color=BLUE, label="surface through the runs")
    runs = [p for p in solution.runs.points if p.stage == solution.stage and p.predicted is not None]
    chi2 = [
        float(np.sum(solution.survey.likelihood.misfit.residuals(p.predicted.value) ** 2))
        - solution.survey.chi2
        for p in runs
        if p.predicted is not None
    ]
    at = [next(iter(p.values.values())) for p in runs]
    near = [number for number, excess in enumerate(chi2) if excess < 6 * crit]
    axes.plot([at[n] for n in near], [chi2[n] for n in near], "o", color=BLACK, markersize=4, label="runs")
    axes.axhline(crit, color=VERMILION, linewidth=1.2, linestyle="--", label=f"{100 * result.fit.level:g} %")
    axes.set_xlabel(result.names.label(path))
    axes.set_ylabel("Δχ²")
    axes.set_title(f"misfit against {result.names.name(path)}", loc="left")
    axes.legend(loc="best")
    return figure


def _plain_numbers(axis: Axis) -> None:
    """Tick labels of a logarithmic axis as plain numbers."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _around(place: np.ndarray, inside: np.ndarray, best: float) -> np.ndarray:
    """The places inside that are connected with the best one; there are no runs around the others."""
    middle = int(np.argmin(np.abs(place - best)))
    gaps = np.flatnonzero(~inside)
    first = max(gaps[gaps < middle], default=-1)
    last = min(gaps[gaps > middle], default=len(place))
    number = np.arange(len(place))
    return (number > first) & (number < last)


def _flow_curve(result: FitResult) -> Figure | None:
    if not result.curves:
        return None
    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axes = figure.add_subplot()
    for curve, colour in zip(result.curves, (BLUE, VERMILION, GREY), strict=False):
        of = f"body {curve.body}" if len(result.curves) > 1 else "fitted"
        axes.fill_between(curve.rate, curve.low, curve.high, color=colour, alpha=0.25, linewidth=0)
        axes.plot(curve.rate, curve.stress, color=colour, label=f"{of}, band at {100 * result.fit.level:g} %")
    axes.set_xscale("log")
    _plain_numbers(axes.xaxis)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("shear rate (1/s)")
    axes.set_ylabel("shear stress (Pa)")
    axes.set_title("flow curve over the shear rates that the tests reached", loc="left")
    axes.legend(loc="best")
    return figure
