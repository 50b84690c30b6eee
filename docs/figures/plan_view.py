"""The deposit of a quarter model from above, with the bars that stand in it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from mpmkit.case import load_case
from mpmkit.output import read_frame, read_frames


def draw_plan(run: Path, picture: Path) -> None:
    """Draw how deep the material lies in the last frame, in all four quarters.

    The depth of each cell is that of the mean of the cells around it, as single cells scatter.
    """
    case, (time, last) = load_case(run / "case.json"), read_frames(run / "frames")[-1]
    frame = read_frame(last)
    cell, ends = case.grid.cell_size, [case.grid.domain[axis][1] for axis in "xy"]
    volume = 8 * frame["half_size"].prod(axis=1)
    cells = [round(end / cell) for end in ends]
    held, _, _ = np.histogram2d(
        *frame["position"][:, :2].T, bins=cells, range=[[0, end] for end in ends], weights=volume
    )
    quarter = _mean_around(held / cell**2)
    whole = np.block([[quarter[::-1, ::-1], quarter[::-1]], [quarter[:, ::-1], quarter]])
    sheet = Figure(figsize=(4.6, 3.8), dpi=160, layout="constrained")
    FigureCanvasAgg(sheet)
    plot = sheet.subplots()
    x, y = (1e3 * end for end in ends)
    image = plot.imshow(
        np.where(whole > 0, 1e3 * whole, np.nan).T, origin="lower", extent=(-x, x, -y, y), cmap="viridis"
    )
    for wall in case.walls.values():
        shape = wall.surface.shape
        if shape.name == "cylinder":
            for sx, sy in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
                middle = (1e3 * sx * shape.base[0], 1e3 * sy * shape.base[1])
                plot.add_patch(Circle(middle, 1e3 * shape.radius, facecolor="white", edgecolor="k", lw=0.8))
    plot.set(xlabel="x (mm)", ylabel="y (mm)", title=f"from above, t = {time:.3g} s")
    sheet.colorbar(image, label="depth (mm)", shrink=0.9)
    sheet.savefig(picture)


def _mean_around(depth: np.ndarray) -> np.ndarray:
    """The mean of each cell and its eight neighbours; planes of symmetry are at the lower ends."""
    padded = np.pad(np.pad(depth, ((1, 0), (1, 0)), mode="symmetric"), ((0, 1), (0, 1)))
    n, m = depth.shape
    return np.mean([padded[i : i + n, j : j + m] for i in range(3) for j in range(3)], axis=0)
