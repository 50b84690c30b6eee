"""Draw docs/images/stability/viscous.png: the step that a regularised yield stress bears, and beyond it.

    python docs/figures/stability/viscous.py [--draw]

Takes about five minutes; with --draw, from docs/data/stability_viscous.nc, a second.
"""

from __future__ import annotations

import itertools
import math

import numba
import numpy as np
import xarray as xr
from maps import COLOURS, make
from maps import panels as new_panels
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from viscous_scenes import SOUND, block, creep, limit

import mpmkit
from mpmkit.stability import Criteria, critical_fraction

CELLS = [0.02, 0.005]
EXPONENTS = np.geomspace(0.01, 1000, 6)
SCHEMES = {
    "USL, FLIP": {"order": "usl", "velocity": "flip"},
    "USF, FLIP": {"order": "usf", "velocity": "flip"},
    "USF, APIC": {"order": "usf", "velocity": "apic"},
}
FORMS = ["explicit", "relaxed", "exact"]
BEYOND = np.array([0.3, 0.6, 1, 2, 4, 8, 16, 40, 81, 200, 500])


def measure() -> xr.Dataset:
    numba.set_num_threads(1)
    shape = (len(FORMS), len(SCHEMES), len(CELLS), len(EXPONENTS))
    stable = np.full(shape, np.nan)
    judge = Criteria(energy=1.0, momentum=math.inf, distance=math.inf)
    for (i, form), (j, scheme), (k, dx), (e, m) in itertools.product(
        enumerate(FORMS), enumerate(SCHEMES.values()), enumerate(CELLS), enumerate(EXPONENTS)
    ):
        if form == "exact" and e:  # it has no exponent
            stable[i, j, k, e] = stable[i, j, k, 0]
        if form != "explicit" and (j or (form == "exact" and e)):  # those are drawn of one scheme
            continue
        found = critical_fraction(block(dx, m, form, scheme), judge, largest=8.0)
        limits = mpmkit.Simulation(block(dx, m, form, scheme)).limits
        stable[i, j, k, e] = found.fraction * limits.as_dict()[found.limit]
        print(form, *scheme.values(), dx, m, found.limit, f"{found.fraction:.3g} {found.unstable:.3g}")
    crept = [[creep(ratio, scheme) for ratio in BEYOND] for scheme in SCHEMES.values()]
    print(np.round(crept, 2))
    return xr.Dataset(
        {
            "stable": (
                ("form", "scheme", "cell_size", "m"),
                stable,
                {"units": "s", "long_name": "largest stable step", "description": "to 6 %"},
            ),
            "creep": (
                ("scheme", "ratio"),
                crept,
                {"units": "1", "long_name": "creep of a channel below yield over the exact one"},
            ),
        },
        {
            "form": FORMS,
            "scheme": list(SCHEMES),
            "cell_size": ("cell_size", CELLS, {"units": "m"}),
            "m": ("m", EXPONENTS, {"units": "s", "long_name": "Papanastasiou's exponent"}),
            "ratio": ("ratio", BEYOND, {"units": "1", "long_name": "step over the viscous limit"}),
        },
    )


def draw(data: xr.Dataset) -> Figure:
    figure, panels = new_panels(1, 2, (7.4, 4.2), width_ratios=[1.25, 1])
    draw_limits(panels[0, 0], data)
    draw_creep(panels[0, 1], data)
    return figure


MARKS = {
    "USL, FLIP": (COLOURS["usl"], "o"),
    "USF, FLIP": (COLOURS["usf"], "s"),
    "USF, APIC": ("#56B4E9", "D"),
}


def draw_limits(axes: Axes, data: xr.Dataset) -> None:
    m = np.geomspace(0.01, 1000, 200)
    for dx, face in zip(CELLS, ("full", "none"), strict=True):
        axes.plot(m, 1e3 * limit(dx, m), color="black", linewidth=0.9)
        axes.axhline(1e3 * dx / SOUND, color="grey", linewidth=0.9, linestyle="--")
        for scheme, (colour, marker) in MARKS.items():
            one = data.stable.sel(scheme=scheme, cell_size=dx)
            style = {"color": colour, "fillstyle": face, "linestyle": "none"}
            axes.plot(data.m, 1e3 * one.sel(form="explicit"), marker, markersize=5, **style)
            if scheme == "USL, FLIP":
                axes.plot(data.m, 1e3 * one.sel(form="relaxed"), "^", markersize=5, **style)
                axes.plot(data.m, 1e3 * one.sel(form="exact"), "_", markersize=9, **style)
    axes.set(xscale="log", yscale="log", xlabel="regularisation m / s", ylabel="largest stable step / ms")
    axes.set_title("A block at rest, free surfaces", fontsize=9, loc="left")
    for scheme, (colour, marker) in MARKS.items():
        axes.plot([], [], marker, color=colour, markersize=5, label=f"explicit, {scheme}")
    axes.plot([], [], "^", color=COLOURS["usl"], markersize=5, label="relaxed, USL, FLIP")
    axes.plot([], [], "_", color=COLOURS["usl"], markersize=9, label="exact yield, USL, FLIP")
    axes.plot([], [], color="black", linewidth=0.9, label="0.375 ρ dx²/(τ0 m + μp)")
    axes.plot([], [], color="grey", linestyle="--", linewidth=0.9, label="dx/c")
    axes.legend(
        fontsize=7, frameon=False, loc="lower left", title="filled: 20 mm, open: 5 mm", title_fontsize=7
    )


def draw_creep(axes: Axes, data: xr.Dataset) -> None:
    for scheme, (colour, marker) in MARKS.items():
        axes.plot(
            data.ratio, data.creep.sel(scheme=scheme), marker, color=colour, markersize=4.5, label=scheme
        )
    ratio = np.array([1.0, 500.0])
    axes.plot(ratio, ratio, color="black", linewidth=0.9, label="step / limit")
    axes.axvline(81, color="grey", linewidth=0.9, linestyle=":", label="the paper's step")
    axes.set(xscale="log", yscale="log", xlabel="step / viscous limit", ylabel="creep / exact creep")
    axes.set_title("Beyond: a channel below yield", fontsize=9, loc="left")
    axes.legend(fontsize=7, frameon=False, loc="upper left")


if __name__ == "__main__":
    make("viscous", measure, draw)
