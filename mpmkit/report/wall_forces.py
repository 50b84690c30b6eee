"""Picture: force of the walls on the material against time, with torque and power if they move."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ..output import read_wall_frame
from .run_results import RunResults
from .style import GREY
from .wall_lines import legend_handles, looks

MOST = 8
"""Most walls that are drawn, those with the largest forces; more lines could not be distinguished."""
NOTHING = 1e-6
"""A quantity below this part of the largest is rounding and is not drawn."""
LOOKS = 8
"""Frames in which rotation of a wall is checked."""
WIDTH, HEIGHT, AROUND = 7.2, 2.0, 1.1
"""Width of the page, height of a chart, and room for title, times and legend, inch."""


class Chart(NamedTuple):
    """One quantity of all walls."""

    label: str
    values: np.ndarray
    """(rows, walls)"""


def draw(results: RunResults) -> Figure | None:
    """A chart for each component of the force, for the torque if a wall turns, and for the power if one
    moves.

    None if the case has no walls, or its history fewer than two rows.
    """
    if not results.case.get("walls") or "wall_force" not in results.history or len(results.time) < 3:
        return None
    charts = charts_of(results)
    rows = max(1, len(charts))
    figure = Figure(figsize=(WIDTH, AROUND + HEIGHT * rows), layout="constrained")
    title = f"{results.title}: walls on the material"
    figure.suptitle(title, x=0.01, ha="left", fontweight="bold", fontsize=12)
    panels = figure.subplots(rows, sharex=True, squeeze=False)[:, 0]
    panels[-1].set_xlabel("time (s)")
    if not charts:
        note = "no wall was touched"
        panels[0].text(0.5, 0.5, note, transform=panels[0].transAxes, ha="center", color=GREY)
        return figure
    chosen, left_out = chosen_of(charts)
    names = [str(name) for name in results.history["wall"].values]
    look = looks(names, list(results.case["walls"]))
    for axes, chart in zip(panels, charts, strict=True):
        for wall in chosen:
            if chart.values[:, wall].any():
                axes.plot(results.time[1:], chart.values[:, wall], **look[names[wall]])
        axes.set_ylabel(chart.label)
        axes.margins(x=0)
    figure.align_ylabels(panels)
    figure.legend(
        handles=legend_handles(look, {names[wall] for wall in chosen}),
        loc="outside lower center",
        ncols=4,
        title=f"and {left_out} more, with smaller forces" if left_out else None,
    )
    return figure


def chosen_of(charts: list[Chart]) -> tuple[list[int], int]:
    """The walls that are drawn, in their order, and the number of other walls that act on the material."""
    shares = [np.abs(values).max(axis=0) / np.abs(values).max() for _, values in charts]
    largest = np.max(shares, axis=0)
    acting = np.flatnonzero(largest > NOTHING)
    chosen = acting[np.argsort(-largest[acting], kind="stable")][:MOST]
    return sorted(map(int, chosen)), len(acting) - len(chosen)


def charts_of(results: RunResults) -> list[Chart]:
    """The charts, without those in which everything is rounding. The first row of a history has no means."""
    force, torque, power = (
        np.nan_to_num(results.history[f"wall_{name}"].values[1:], posinf=0.0, neginf=0.0)
        for name in ("force", "torque", "power")
    )
    axes = [str(axis) for axis in results.history["component"].values]
    about = [str(axis) for axis in results.history["about"].values]
    charts = [_of(f"force along {axis} (N)", force[..., k], force) for k, axis in enumerate(axes)]
    turning = _turning(results)
    charts += [
        _of(f"torque about {axis} (N m)", torque[..., k], torque)
        for k, axis in enumerate(about)
        if axis in turning
    ]
    charts.append(_of("power (W)", power, power))
    return [chart for chart in charts if chart is not None]


def _of(label: str, values: np.ndarray, all_of_its_kind: np.ndarray) -> Chart | None:
    largest = np.abs(values).max(initial=0.0)
    return Chart(label, values) if largest > NOTHING * np.abs(all_of_its_kind).max(initial=0.0) else None


def _turning(results: RunResults) -> set[str]:
    """The axes about which a wall turns in some frame, as the history calls them."""
    about = [str(axis) for axis in results.history["about"].values]
    times = list(results.walls)
    rates = [
        _rate(*read_wall_frame(path))
        for time in times[:: max(1, len(times) // LOOKS)]
        for path in results.walls[time].values()
    ]
    if len(about) == 1:  # a scene in two dimensions lies in the xy plane of its frames
        return {axis for axis in about if any(rate.any() for rate in rates)}
    return {axis for k, axis in enumerate(about) if any(rate[k] != 0 for rate in rates)}


def _rate(points: np.ndarray, parts: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Angular velocity ω, rad/s, (3,), for the best fit of v - v̄ = ω × (x - x̄); 0 if it is rounding."""
    arm, own = points - points.mean(axis=0), velocity - velocity.mean(axis=0)
    if not np.abs(own).max() > NOTHING * np.abs(velocity).max():
        return np.zeros(3)
    x, y, z = arm.T
    o = np.zeros_like(x)
    cross = np.array([[o, z, -y], [-z, o, x], [y, -x, o]]).transpose(2, 0, 1).reshape(-1, 3)
    rate = np.linalg.lstsq(cross, own.reshape(-1), rcond=None)[0]
    return np.where(np.abs(rate) > NOTHING * np.abs(rate).max(), rate, 0.0)
