"""Draw docs/images/stability/cell_crossing.png: linear hats and cpGIMP where particles cross cells.

    python docs/figures/stability/cell_crossing.py [--draw]

Takes two minutes; with --draw, from docs/data/stability_cell_crossing.nc, a second. The scene is the
manufactured solution of tests/validation: a periodic elastic bar that a body force makes swing.
"""

from __future__ import annotations

import itertools

import numba
import numpy as np
import xarray as xr
from maps import make
from maps import panels as new_panels
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

# isort: split
from manufactured import Bar  # of tests/validation, which is on the path only now

SHAPES = ["linear", "cpgimp"]
AMPLITUDES = np.geomspace(0.05, 1.6, 11)
PER_CELL = [1, 2, 3, 4]
CELLS = [16, 32, 64]
FINE = 64
SHADES = {16: "#56B4E9", 32: "#0072B2", 64: "#000000"}


def measure() -> xr.Dataset:
    numba.set_num_threads(1)
    cells = np.full((len(SHAPES), len(CELLS), len(PER_CELL), len(AMPLITUDES)), np.nan)
    for (i, shape), (j, N), (k, n), (a, amplitude) in itertools.product(
        enumerate(SHAPES), enumerate(CELLS), enumerate(PER_CELL), enumerate(AMPLITUDES)
    ):
        if N == FINE or n == 2:
            bar = Bar(N, amplitude / N, particles=n, shape=shape, order="usf")
            cells[i, j, k, a] = bar.largest_error()
            print(shape, N, n, f"{amplitude:.3f} {cells[i, j, k, a]:.4g}", flush=True)
    return xr.Dataset(
        {
            "error": (
                ("shape", "cells", "per_cell", "amplitude"),
                cells,
                {"units": "1", "long_name": "largest error of the displacement over its amplitude"},
            )
        },
        {
            "shape": SHAPES,
            "cells": ("cells", CELLS, {"long_name": "cells of the bar"}),
            "per_cell": ("per_cell", PER_CELL, {"long_name": "particles per cell"}),
            "amplitude": ("amplitude", AMPLITUDES, {"units": "1", "long_name": "amplitude, in cells"}),
        },
    )


def draw(data: xr.Dataset) -> Figure:
    figure, panels = new_panels(1, 2, (8.2, 4.2))
    draw_cells(panels[0, 0], data)
    draw_map(figure, panels[0, 1], data)
    return figure


def draw_cells(axes: Axes, data: xr.Dataset) -> None:
    for N, shape in itertools.product(CELLS, SHAPES):
        style = {"linear": {"marker": "o", "fillstyle": "none"}, "cpgimp": {"marker": "s", "ls": "--"}}[shape]
        one = data.error.sel(shape=shape, cells=N, per_cell=2)
        name = "linear" if shape == "linear" else "cpGIMP"
        axes.plot(
            data.amplitude,
            one,
            color=SHADES[N],
            markersize=4,
            linewidth=1,
            label=f"{name}, {N} cells",
            **style,
        )
    axes.axvline(0.25, color="#D55E00", linewidth=1, linestyle=":")
    axes.set(xscale="log", yscale="log", ylim=(0.003, 1.6))
    axes.set(xlabel="amplitude / cell", ylabel="largest error of displacement / amplitude")
    axes.legend(fontsize=7, frameon=False, loc="upper left", ncols=2)
    axes.set_title("Two particles per cell, USF", fontsize=9, loc="left")


def draw_map(figure: Figure, axes: Axes, data: xr.Dataset) -> None:
    fine = data.error.sel(cells=FINE)
    ratio = fine.sel(shape="linear") / fine.sel(shape="cpgimp")
    rows = np.arange(len(PER_CELL))
    mesh = axes.pcolormesh(
        data.amplitude, rows, ratio, norm=LogNorm(1, 60), cmap="cividis", shading="nearest"
    )
    for row, n in zip(rows, PER_CELL, strict=True):
        label = "1/(2 n): the first particle crosses" if row == 0 else None
        axes.plot([0.5 / n] * 2, [row - 0.5, row + 0.5], color="#D55E00", linewidth=2, label=label)
    axes.set(xscale="log", xlabel="amplitude / cell", ylabel="particles per cell, n")
    axes.set_yticks(rows, map(str, PER_CELL))
    axes.grid(visible=False)
    bar = figure.colorbar(mesh, ax=axes, label="error, linear / cpGIMP")
    bar.set_ticks([1, 3, 10, 30], labels=["1", "3", "10", "30"])
    axes.legend(fontsize=7, loc="upper right")
    axes.set_title(f"{FINE} cells", fontsize=9, loc="left")


if __name__ == "__main__":
    make("cell_crossing", measure, draw)
