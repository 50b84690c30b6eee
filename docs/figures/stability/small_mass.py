"""Draw docs/images/stability/small_mass.png: what a node that is barely touched leaves of the step.

    python docs/figures/stability/small_mass.py [--draw]

Takes two minutes; with --draw, from docs/data/stability_small_mass.nc, a second.
"""

from __future__ import annotations

import itertools

import numba
import numpy as np
import xarray as xr
from amplification import growth, largest_step
from maps import COLOURS, ORDERS, make
from maps import panels as new_panels
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from stability import FLIP, free_bar  # of tests/validation

import mpmkit

RUBBER = {"law": "neo-hookean", "density": 1.0, "youngs_modulus": 1.0, "poisson_ratio": 0.0}
SHAPES = {"linear": ("o", "none"), "cpgimp": ("s", "full")}
REACH = np.geomspace(0.2, 1e-6, 12)
PER_CELL = [1, 2, 3, 4, 6, 8, 12, 16]
CORNER = 6
"""Most particles an axis of a block: the matrix has twelve times their square of rows."""
TAKEN = 0.4
"""Of dx/c: what USL takes at most."""


def corner(n: int) -> mpmkit.Simulation:
    """A block of an inviscid fluid, USL and own pressure, that reaches a little over nodes along x and z."""
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 1.0,
                "gravity": [0, 0],
                "grid": {"cell_size": 1.0, "domain": {"x": [0, 8], "z": [0, 8]}},
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [2, 2], "upper": [4, 4]},
                        "material": {"law": "newtonian", "density": 1, "viscosity": 0, "sound_speed": 1},
                        "particles_per_cell": n * n,
                    }
                ],
                "scheme": FLIP | {"order": "usl"},
            }
        )
    )
    simulation.particles.position += 1e-3 / n
    return simulation


def measure() -> xr.Dataset:
    numba.set_num_threads(1)
    stable = np.empty((len(SHAPES), len(ORDERS), len(REACH)))
    grown = np.empty_like(stable)
    for (i, shape), (j, order), (k, reach) in itertools.product(
        enumerate(SHAPES), enumerate(ORDERS), enumerate(REACH)
    ):
        bar = free_bar(RUBBER, shape, reach, order=order)
        stable[i, j, k], grown[i, j, k] = largest_step(bar, 1e-4, 3.0), growth(bar, TAKEN)
        print(shape, order, f"{reach:.1e} {stable[i, j, k]:.4g} {grown[i, j, k]:.4g}")
    thin = np.empty((len(ORDERS), len(PER_CELL)))
    for (j, order), (k, n) in itertools.product(enumerate(ORDERS), enumerate(PER_CELL)):
        parts = (0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9)  # of the last box, beyond the node
        thin[j, k] = min(
            largest_step(free_bar(RUBBER, "cpgimp", part / n, n, order=order), 0.05, 3.0) for part in parts
        )
        print("thin", order, n, f"{thin[j, k]:.4g}")
    corners = [largest_step(corner(n), 0.2, 1.0, 40, axes=2) if n <= CORNER else np.nan for n in PER_CELL]
    print("corner", np.round(corners, 4))
    about = {"units": "1", "long_name": "largest stable step over dx/c"}
    return xr.Dataset(
        {
            "stable": (("shape", "order", "reach"), stable, about),
            "growth": (
                ("shape", "order", "reach"),
                grown,
                {"units": "1", "long_name": f"largest eigenvalue of a step of {TAKEN} dx/c"},
            ),
            "by_width": (("order", "per_cell"), thin, about | {"description": "cpGIMP, the worst reach"}),
            "corner": ("per_cell", corners, about | {"description": "USL, corner of a plane fluid block"}),
        },
        {
            "shape": list(SHAPES),
            "order": ORDERS,
            "reach": ("reach", REACH, {"units": "1", "long_name": "reach over the node, in cells"}),
            "per_cell": ("per_cell", PER_CELL, {"long_name": "particles per cell, each 1/n of it wide"}),
        },
    )


def draw(data: xr.Dataset) -> Figure:
    figure, panels = new_panels(1, 2, (8.2, 4.6), width_ratios=[1.35, 1])
    draw_reach(panels[0, 0], data)
    draw_width(panels[0, 1], data)
    return figure


def draw_reach(axes: Axes, data: xr.Dataset) -> None:
    for (shape, (marker, fill)), (i, order) in itertools.product(SHAPES.items(), enumerate(ORDERS)):
        one = data.stable.sel(shape=shape, order=order)
        size = 7 - 2 * i  # USF and MUSL fall on each other
        axes.plot(
            data.reach, one, marker, color=COLOURS[order], fillstyle=fill, markersize=size, linestyle="none",
            label=f"{order.upper()}, {'cpGIMP' if shape == 'cpgimp' else shape}",
        )  # fmt: skip
    axes.plot(data.reach, np.sqrt(2 * data.reach), color="black", linewidth=0.9, label="√(2 e)")
    axes.axhline(np.sqrt(0.5), color="black", linewidth=0.9, linestyle="--", label="√w, boxes of half a cell")
    axes.set(xscale="log", yscale="log", ylim=(8e-4, 4))
    axes.set(xlabel="reach e over the next node / cell", ylabel="largest stable step / (dx/c)")
    axes.legend(fontsize=7, frameon=False, loc="lower right")
    axes.set_title("A free end, two particles per cell", fontsize=9, loc="left")


def draw_width(axes: Axes, data: xr.Dataset) -> None:
    w = 1 / data.per_cell
    for i, order in enumerate(ORDERS):
        axes.plot(
            w,
            data.by_width.sel(order=order),
            "s",
            color=COLOURS[order],
            markersize=7 - 2 * i,
            label=order.upper(),
        )
    axes.plot(w, data.corner, "D", color=COLOURS["usl"], fillstyle="none", label="USL, corner of a fluid")
    line = np.geomspace(1 / 16, 1, 50)
    axes.plot(line, np.sqrt(line), color="black", linewidth=0.9, linestyle="--", label="√w")
    axes.axhline(TAKEN, color="black", linewidth=0.9, linestyle=":", label="what USL takes at most")
    axes.set(xscale="log", yscale="log", ylim=(0.15, 4))
    axes.set(xlabel="width w of a box / cell", ylabel="largest stable step / (dx/c)")
    axes.set_xticks([1 / 16, 1 / 8, 1 / 4, 1 / 2, 1], ["1/16", "1/8", "1/4", "1/2", "1"])
    axes.set_yticks([0.2, 0.4, 0.7, 1, 2], ["0.2", "0.4", "0.7", "1", "2"])
    axes.minorticks_off()
    axes.legend(fontsize=7, frameon=False, loc="upper left", ncols=2)
    axes.set_title("Thin boxes, cpGIMP, worst reach", fontsize=9, loc="left")


if __name__ == "__main__":
    make("small_mass", measure, draw)
