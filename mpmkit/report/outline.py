"""Picture: the shape of the material at a few times, as in figure 5 of a paper on the slump test."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from .domain import Domain, domain_of
from .filling import triangles_between
from .images import beyond_faces
from .panels import Panels
from .run_results import RunResults
from .section import Section, lengths_of, plane_of, section_of
from .style import BLACK, COLOUR_MAP, GREY, MILLIMETRES
from .wall_lines import Lines, draw_walls, legend_handles, looks, wall_lines

DEFAULT_TIMES = (0.0, 0.1, 0.2, 0.5)
AROUND, AROUND_WALLS = 0.04, 0.12
"""Margin of a panel around the material, relative to its largest side; larger with walls."""
FEWEST_DIGITS, MOST_DIGITS = 3, 12
"""Decimals of a time; more than the least only if two panels would show the same time."""


@dataclass(frozen=True)
class Snapshot:
    """The material at one time."""

    time: float
    section: Section
    lengths: dict[str, float]
    """spread and height, m, if known"""
    walls: Lines


def draw(results: RunResults) -> Figure | None:
    """One panel for each snapshot time that the run reached, and one for its end; None without frames."""
    if not results.frames:
        return None
    domain, plane = domain_of(results), plane_of(results)
    snapshots = [
        Snapshot(
            time,
            section_of(path, results, plane, domain),
            lengths_of(path, results),
            wall_lines(results, time, plane, domain),
        )
        for time, path in chosen_frames(results)
    ]
    shown = [snapshot.section for snapshot in snapshots if len(snapshot.section)]
    if not shown:
        return None
    walls = list(results.case.get("walls") or ())
    look = looks(walls, walls)
    lower, upper = limits(shown, domain, AROUND_WALLS if walls else AROUND)
    panels = Panels(len(snapshots), upper - lower)
    colours, extend = _colours([snapshot.section for snapshot in snapshots], results.stopped_by_guard)
    digits = _digits([snapshot.time for snapshot in snapshots])
    for axes, snapshot in zip(panels.axes, snapshots, strict=True):
        body = add_section(axes, snapshot.section, colours, domain, results.case["grid"]["cell_size"])
        draw_walls(axes, snapshot.walls, look)
        if domain.floor is not None:
            axes.axhline(domain.floor * MILLIMETRES, color=BLACK, linewidth=1.5)
        axes.set_xlim(lower[0] * MILLIMETRES, upper[0] * MILLIMETRES)
        axes.set_ylim(lower[1] * MILLIMETRES, upper[1] * MILLIMETRES)
        axes.set_title(_label(results, snapshot, digits), loc="left", fontsize=9.5, fontweight="normal")
        if not len(snapshot.section):
            note = "nothing in this section"
            axes.text(0.5, 0.5, note, transform=axes.transAxes, ha="center", color=GREY)
    panels.label(f"{'r' if results.case['space'] == 'axisymmetric' else 'x'} (mm)", "z (mm)")
    if handles := legend_handles(look, _seen([snapshot.walls for snapshot in snapshots], lower, upper)):
        panels.legend(handles)
    panels.colour_bar(body, "speed (m/s)", extend)
    where = "" if plane is None else f", section at y = {plane * MILLIMETRES:.4g} mm"
    panels.title(f"{results.title}: shape{where}")
    return panels.figure


def chosen_frames(results: RunResults) -> list[tuple[float, Path]]:
    """The frames nearest to the snapshot times of the case that the run reached, and the last frame."""
    times = np.array([time for time, _ in results.frames])
    wanted = (results.case.get("output") or {}).get("snapshot_times", DEFAULT_TIMES)
    # Up to half a frame interval after the end counts as the end.
    reach = times[-1] + (np.diff(times).min() / 2 if len(times) > 1 else 0)
    nearest = {int(np.argmin(np.abs(times - time))) for time in wanted if time <= reach}
    return [results.frames[index] for index in sorted(nearest | {len(times) - 1})]


def _seen(walls: list[Lines], lower: np.ndarray, upper: np.ndarray) -> set[str]:
    """The walls that are partly within the limits of a panel."""
    return {
        name
        for lines in walls
        for name, segments in lines.items()
        if ((segments.min(axis=1) <= upper) & (segments.max(axis=1) >= lower)).all(axis=1).any()
    }


def limits(sections: list[Section], domain: Domain, around: float) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner of a panel, m: around the material, within the domain, down to a floor."""
    lower = np.maximum(np.min([section.lower for section in sections], axis=0), domain.lower)
    upper = np.minimum(np.max([section.upper for section in sections], axis=0), domain.upper)
    if domain.floor is not None:
        lower[1] = domain.floor
    size = (upper - lower).max()
    margin = np.full(2, around * size)
    below = margin if domain.floor is None else np.array([around, AROUND]) * size
    return lower - below, upper + margin


def _colours(sections: list[Section], stopped_by_guard: bool) -> tuple[Normalize, str]:
    """The scale of the speeds, and the ends that speeds may exceed.

    A run stopped by a guard can have such large final speeds that all earlier ones would have the same
    colour.
    """
    fastest = [float(section.value.max()) if len(section) else 0.0 for section in sections]
    trusted = fastest[:-1] if stopped_by_guard and len(fastest) > 1 else fastest
    top = max(trusted) or max(fastest) or 1.0
    return Normalize(0, top), "max" if max(fastest) > top else "neither"


def add_section(
    axes: Axes,
    section: Section,
    colours: Normalize,
    domain: Domain,
    cell_size: float,
    colour_map: str | Colormap = COLOUR_MAP,
) -> PolyCollection:
    """Draw a section up to the faces of the domain; triangles close the gaps between neighbours."""
    section = beyond_faces(section, domain, cell_size)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    rectangles = section.centre[:, None, :] + corners * section.half_size[:, None, :]
    between = triangles_between(section, cell_size)
    # A triangle is drawn as a quadrilateral with one corner twice; the boxes lie on top.
    triangles = section.centre[between[:, [0, 1, 2, 2]]]
    # A thin edge of its own colour closes the hairlines between neighbours.
    body = PolyCollection(
        [*(np.concatenate([triangles, rectangles]) * MILLIMETRES)],
        array=np.concatenate([section.value[between].mean(axis=1), section.value]),
        norm=colours,
        cmap=colour_map,
        linewidths=0.4,
        edgecolors="face",
        zorder=2,
    )
    axes.add_collection(body)
    # The part of a box behind a face is not drawn.
    width, height = (domain.upper - domain.lower) * MILLIMETRES
    corner = (domain.lower[0] * MILLIMETRES, domain.lower[1] * MILLIMETRES)
    body.set_clip_path(Rectangle(corner, width, height, transform=axes.transData))
    body.set_in_layout(False)  # clipped parts need no space beside the panel
    return body


def _digits(times: list[float]) -> int:
    """Decimals with which all times differ."""
    for digits in range(FEWEST_DIGITS, MOST_DIGITS):
        if len({f"{time:.{digits}f}" for time in times}) == len(times):
            return digits
    return MOST_DIGITS


def _label(results: RunResults, snapshot: Snapshot, digits: int) -> str:
    when = f"t = {snapshot.time:.{digits}f} s"
    if results.stopped_by_guard and snapshot.time == results.frames[-1][0]:
        return f"{when}\nstopped by a guard"
    known = [f"{word} {value * MILLIMETRES:.0f} mm" for word, value in snapshot.lengths.items()]
    return f"{when}\n{', '.join(known)}".rstrip()
