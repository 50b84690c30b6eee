"""Picture: the shape of the material at a few times, as in figure 5 of a paper on the slump test."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .panels import Panels
from .run_results import RunResults
from .section import Section, plane_of, section_of
from .style import BLACK, COLOUR_MAP, MILLIMETRES

DEFAULT_TIMES = (0.0, 0.1, 0.2, 0.5)


@dataclass(frozen=True)
class Snapshot:
    """The material at one time."""

    time: float
    section: Section


def draw(results: RunResults) -> Figure | None:
    """One panel for each snapshot time that the run reached, and one for its end; None without frames."""
    if not results.frames:
        return None
    plane = plane_of(results)
    snapshots = [Snapshot(time, section_of(path, results, plane)) for time, path in chosen_frames(results)]
    lower = np.min([snapshot.section.lower for snapshot in snapshots], axis=0)
    upper = np.max([snapshot.section.upper for snapshot in snapshots], axis=0)
    floor = floor_of(results)
    if floor is not None:
        lower[1] = min(lower[1], floor)
    margin = 0.04 * (upper - lower).max()
    lower, upper = lower - margin, upper + margin

    panels = Panels(len(snapshots), upper - lower)
    colours = Normalize(0, max(snapshot.section.speed.max() for snapshot in snapshots) or 1.0)
    for axes, snapshot in zip(panels.axes, snapshots, strict=True):
        body = _add_section(axes, snapshot.section, colours)
        if floor is not None:
            axes.axhline(floor * MILLIMETRES, color=BLACK, linewidth=1.5)
        axes.set_xlim(lower[0] * MILLIMETRES, upper[0] * MILLIMETRES)
        axes.set_ylim(lower[1] * MILLIMETRES, upper[1] * MILLIMETRES)
        axes.set_title(_label(results, snapshot.time), loc="left", fontsize=9.5, fontweight="normal")
    panels.label(f"{'r' if results.case['space'] == 'axisymmetric' else 'x'} (mm)", "z (mm)")
    panels.colour_bar(body, "speed (m/s)")
    panels.figure.suptitle(f"{results.title}: shape", fontweight="bold", fontsize=12)
    return panels.figure


def chosen_frames(results: RunResults) -> list[tuple[float, Path]]:
    """The frames nearest to the snapshot times of the case that the run reached, and the last frame."""
    times = np.array([time for time, _ in results.frames])
    wanted = (results.case.get("output") or {}).get("snapshot_times", DEFAULT_TIMES)
    # Half a frame's interval beyond the end is still the end.
    reach = times[-1] + (np.diff(times).min() / 2 if len(times) > 1 else 0)
    nearest = {int(np.argmin(np.abs(times - time))) for time in wanted if time <= reach}
    return [results.frames[index] for index in sorted(nearest | {len(times) - 1})]


def floor_of(results: RunResults) -> float | None:
    """Height of the floor, m; None where the lower face of the domain is no wall."""
    grid = results.case["grid"]
    face = grid.get("faces", {}).get("z_min", "open")
    return None if face in ("open", "periodic") else grid["domain"]["z"][0]


def _add_section(axes: Axes, section: Section, colours: Normalize) -> PolyCollection:
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    rectangles = section.centre[:, None, :] + corners * section.half_size[:, None, :]
    # A thin edge of its own colour closes the hairlines between neighbours.
    body = PolyCollection(
        rectangles * MILLIMETRES,
        array=section.speed,
        norm=colours,
        cmap=COLOUR_MAP,
        linewidths=0.4,
        edgecolors="face",
        zorder=2,
    )
    axes.add_collection(body)
    return body


def _label(results: RunResults, time: float) -> str:
    lengths = {"spread": results.at(time, "spread_diameter"), "height": results.at(time, "height")}
    known = [f"{word} {value * MILLIMETRES:.0f} mm" for word, value in lengths.items() if value is not None]
    return f"t = {time:.3f} s\n{', '.join(known)}".rstrip()
