"""A plot of a history in the terminal, made of Braille dots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..output import RunDirectory
from ..output.netcdf import read_dataset

if TYPE_CHECKING:
    import xarray

WIDTH, HEIGHT = 60, 10
"""Size of the plot in characters."""
DOTS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])
"""Bits of the Braille characters of Unicode: four rows of two dots."""
BLANK = 0x2800
CHOICE = (
    ("spread_diameter", 1e3, "spread (mm)"),
    ("height", 1e3, "height (mm)"),
    ("kinetic_energy", 1, "kinetic energy (J)"),
)
"""Variables to plot, of which the first that changes is chosen: name, scale and label."""


def plot(time: np.ndarray, values: np.ndarray, until: float, label: str) -> list[str]:
    """Lines of text with a curve over time from 0 to ``until``, s."""
    kept = np.isfinite(values)
    time, values = time[kept], values[kept]
    low, high = float(values.min()), float(values.max())
    if not high > low:
        low, high = low - 0.5, high + 0.5
    # A value for each column of dots up to now, so that the curve has no holes.
    columns = np.arange(max(1, round(2 * WIDTH * min(1.0, time[-1] / until))))
    along = np.interp((columns + 0.5) / (2 * WIDTH) * until, time, values)
    rows = np.rint((high - along) / (high - low) * (4 * HEIGHT - 1)).astype(int)
    letters = np.full((HEIGHT, WIDTH), BLANK)
    for column, row in zip(columns, rows, strict=True):
        letters[row // 4, column // 2] |= DOTS[row % 4, column % 2]
    sides = [f"{high:.4g}", *[""] * (HEIGHT - 2), f"{low:.4g}"]
    wide = max(map(len, sides))
    lines = [
        f"{side:>{wide}} ┤{''.join(map(chr, row))}" for side, row in zip(sides, letters.tolist(), strict=True)
    ]
    end = f"{until:g} s"
    return [label, *lines, f"{'':{wide}} └{'0':<{WIDTH - len(end)}}{end}"]


class HistoryPlot:
    """The plot of a run in progress, drawn again when its history has changed."""

    def __init__(self, directory: Path) -> None:
        self._path = RunDirectory(directory).history
        self._seen = self._written()
        self.lines: list[str] = []

    def look(self, until: float) -> None:
        """Read the history if it has changed; errors are ignored, because they must not stop the run."""
        written = self._written()
        if written in (None, self._seen):
            return
        self._seen = written
        try:
            dataset = read_dataset(self._path)
        except (OSError, RuntimeError, ValueError):
            return
        chosen = _chosen(dataset)
        if chosen is not None:
            name, scale, label = chosen
            self.lines = plot(dataset["time"].values, scale * dataset[name].values, until, label)

    def _written(self) -> int | None:
        try:
            return self._path.stat().st_mtime_ns
        except OSError:
            return None


def _chosen(dataset: xarray.Dataset) -> tuple[str, float, str] | None:
    for choice in CHOICE:
        values = dataset[choice[0]].values if choice[0] in dataset else np.zeros(0)
        values = values[np.isfinite(values)]
        if len(values) > 1 and np.ptp(values) > 0:
            return choice
    return None
