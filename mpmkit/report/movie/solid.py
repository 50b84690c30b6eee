"""Pictures of a three-dimensional scene: the body as a shaded surface, the floor, and transparent walls."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.collections import PolyCollection
from matplotlib.colors import Colormap

from ..domain import domain_of
from ..run_results import RunResults
from ..section import drawable
from ..style import MILLIMETRES
from ..wall_lines import looks
from .picture import add_scale, add_title, empty_picture, pixels
from .quantities import Quantity, Scale, scale_of
from .splats import brightness, nearest_particles, smoothed
from .view import View, standard_view, wall_triangles, whole

RESOLUTION = 640
"""Pixels across the body's picture."""
AROUND = 0.06
"""Margin around the material, relative to its largest side."""
FLOOR = "#E9E9E6"
ROUND = 1.7
"""Radius of a particle's ball over half the side of its box: the balls of neighbours overlap."""
JUMP = 2.5
"""Largest step of depth, in radii, that is smoothed; a larger one is the edge of a body."""


def solid_pictures(
    results: RunResults, frames: Sequence[tuple[float, Path]], quantity: Quantity
) -> Iterator[np.ndarray]:
    """One picture a frame, RGB bytes, all of the same limits, size and scale."""
    view = standard_view()
    walls = list(results.case.get("walls") or ())
    look = looks(walls, walls)
    loaded = [drawable(path, results, quantity.field) for _, path in frames]
    scale = scale_of(quantity, [frame[quantity.field] for frame in loaded])
    floor = _floor(results, loaded)
    lower, upper = _limits(results, view, loaded, floor)
    for (time, _), frame in zip(frames, loaded, strict=True):
        figure, axes = empty_picture(upper - lower)
        axes.set_axis_off()
        extent = tuple(np.stack([lower, upper], axis=1).ravel() * MILLIMETRES)
        drawn = view.seen(floor)[:, :2] * MILLIMETRES
        axes.add_collection(PolyCollection([drawn], facecolors=FLOOR, zorder=1))
        axes.imshow(_body(results, view, frame, quantity, scale, lower, upper), extent=extent, zorder=2)
        for name, triangles in wall_triangles(results, time).items():
            colour = look[name]["color"]
            drawn = view.seen(triangles)[..., :2] * MILLIMETRES
            axes.add_collection(
                PolyCollection(
                    [*drawn], facecolors=colour, edgecolors=colour, alpha=0.08, linewidths=0.3, zorder=3
                )
            )
        axes.set_xlim(extent[:2])
        axes.set_ylim(extent[2:])
        _draw_ruler(axes, lower, upper)
        add_title(figure, results.title, f"t = {time:.3f} s")
        add_scale(figure, quantity, scale)
        yield pixels(figure)


def _limits(
    results: RunResults, view: View, loaded: Sequence[dict], floor: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Lower left and upper right corner of the pictures, m, around the material and the floor."""
    ends = [view.seen(floor)[:, :2]] if len(floor) else []
    ends += [
        view.seen(points)[:, :2]
        for frame in loaded
        if len(frame["position"])
        for points in whole(results, frame["position"])
    ]
    lower = np.min([points.min(axis=0) for points in ends], axis=0)
    upper = np.max([points.max(axis=0) for points in ends], axis=0)
    margin = AROUND * (upper - lower).max() + results.case["grid"]["cell_size"]
    return lower - margin, upper + margin


def _body(
    results: RunResults,
    view: View,
    frame: dict[str, np.ndarray],
    quantity: Quantity,
    scale: Scale,
    lower: np.ndarray,
    upper: np.ndarray,
) -> np.ndarray:
    """The material as an RGBA picture; pixels without material are transparent."""
    size = upper - lower
    per_metre = RESOLUTION / size[0]
    shape = (max(1, round(size[1] * per_metre)), RESOLUTION)
    copies = [view.seen(points) for points in whole(results, frame["position"])]
    seen = np.concatenate(copies)
    places = np.stack([seen[:, 0] - lower[0], upper[1] - seen[:, 1], seen[:, 2]], axis=1) * per_metre
    radius = np.tile(frame["half_size"].max(axis=1), len(copies)) * ROUND * per_metre
    depth, number = nearest_particles(places, np.maximum(radius, 1.0), shape)
    typical = float(np.median(radius)) if len(radius) else 1.0
    lit = brightness(smoothed(depth, typical, JUMP * typical))
    values = np.tile(frame[quantity.field], len(copies))
    colour_map: Colormap = (
        colormaps[scale.colour_map] if isinstance(scale.colour_map, str) else scale.colour_map
    )
    picture = np.zeros((*shape, 4))
    there = number >= 0
    picture[there] = colour_map(scale.norm(values[number[there]]))
    picture[..., :3] *= lit[..., None]
    return picture


def _floor(results: RunResults, loaded: Sequence[dict]) -> np.ndarray:
    """Corners, m, ``(4, 3)``, of the floor below the material of all frames; none where it has no floor."""
    z = domain_of(results).floor
    if z is None:
        return np.zeros((0, 3))
    places = np.concatenate([copy for frame in loaded for copy in whole(results, frame["position"])])[:, :2]
    margin = AROUND * np.ptp(places, axis=0).max() + results.case["grid"]["cell_size"]
    (left, front), (right, back) = places.min(axis=0) - margin, places.max(axis=0) + margin
    return np.array([[left, front, z], [right, front, z], [right, back, z], [left, back, z]])


def _draw_ruler(axes, lower: np.ndarray, upper: np.ndarray) -> None:
    """Draw a scale bar, 1, 2 or 5 times a power of ten long: the axes are turned and have no ticks."""
    room = 0.3 * (upper[0] - lower[0]) * MILLIMETRES
    power = 10.0 ** np.floor(np.log10(room))
    length = max(step * power for step in (1, 2, 5) if step * power <= room)
    x, y = (corner * MILLIMETRES for corner in (lower + 0.03 * (upper - lower)))
    axes.plot([x, x + length], [y, y], color="black", linewidth=2, solid_capstyle="butt", zorder=4)
    axes.text(x + length / 2, y, f"{length:g} mm", ha="center", va="bottom", fontsize=8, zorder=4)
