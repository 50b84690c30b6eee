"""Draw docs/images/stability/acoustic.png: how much of dx/c the orders bear, inside a body and in a slump.

    python docs/figures/stability/acoustic.py [--draw]

Takes about two minutes; with --draw, from docs/data/stability_acoustic.nc, a second.
"""

from __future__ import annotations

import itertools
import math

import numba
import numpy as np
import xarray as xr
from maps import COLOURS, DOCS, ORDERS, make
from maps import panels as new_panels
from matplotlib.figure import Figure

from mpmkit.case.load import read_json
from mpmkit.stability import Criteria, combinations, critical_fraction

PER_AXIS = [1, 2, 3, 4]
SHAPES, VELOCITIES = ["linear", "cpgimp"], ["flip", "apic"]
CELLS, PERIODS = 32, 10
WAVE = {
    "space": "plane-strain",
    "until": float(PERIODS * CELLS),
    "gravity": [0, 0],
    "grid": {
        "cell_size": 1.0,
        "domain": {"x": [0, CELLS], "z": [0, 2]},
        "faces": {"x_min": "periodic", "x_max": "periodic", "z_min": "slip", "z_max": "slip"},
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0, 0], "upper": [CELLS, 2]},
            "material": {"law": "newtonian", "density": 1, "viscosity": 0, "sound_speed": 1},
            "velocity": {"amplitude": [3e-4, 0], "wave_vector": [2 * math.pi / CELLS, 0]},
        }
    ],
    "scheme": {"volumetric": "own", "redistribution": "none"},
}
# A wave's energies swing by ω dt/2, being known half a step apart, and its phase drifts; neither is growth.
SCENES = {
    "wave": (WAVE, Criteria(energy=1.0, distance=1.0)),
    "slump": (read_json(DOCS.parent / "cases/slump_fast.json") | {"until": 0.2}, Criteria()),
}


def measure() -> xr.Dataset:
    numba.set_num_threads(1)
    kinds = {"velocity": VELOCITIES, "shape": SHAPES, "order": ORDERS}
    found = np.empty((len(SCENES), *map(len, kinds.values()), len(PER_AXIS), 2))
    broken = np.empty(found.shape[:-1], dtype=object)
    for (i, (scene, (data, criteria))), (k, n) in itertools.product(
        enumerate(SCENES.items()), enumerate(PER_AXIS)
    ):
        case = data | {"bodies": [data["bodies"][0] | {"particles_per_cell": n * n}]}
        for at, (labels, one) in zip(
            np.ndindex(*map(len, kinds.values())), combinations(case, kinds), strict=True
        ):
            limit = critical_fraction(one, criteria)
            found[(i, *at, k)] = limit.fraction, limit.unstable
            broken[(i, *at, k)] = limit.broken
            print(scene, n, *labels.values(), f"{limit.fraction:.3g} {limit.unstable:.3g} {limit.broken}")
    dims = ("scene", *kinds, "per_axis")
    about = {"units": "1", "long_name": "time step over dx/c"}
    return xr.Dataset(
        {
            "stable": (
                dims,
                found[..., 0],
                about | {"description": "largest found stable; 0.05 is tried first"},
            ),
            "unstable": (dims, found[..., 1], about | {"description": "smallest found unstable"}),
            "broken": (dims, broken.astype(str), {"long_name": "criterion that it broke"}),
        },
        {
            "scene": list(SCENES),
            **kinds,
            "per_axis": ("per_axis", PER_AXIS, {"long_name": "particles an axis"}),
        },
    )


def theory(velocity: str, order: str, n: np.ndarray) -> np.ndarray:
    """Inside a body, of dx/c, with F what mapping to the particles and back leaves of the steepest mode."""
    F = (1 - 1 / n**2) / 3 if velocity == "flip" else np.ones_like(n)
    if order == "usl":
        return 1 / np.sqrt(2 - F)
    return 2 * np.sqrt(1 - F) if velocity == "flip" else F  # a longer wave is the first to grow with FLIP


def draw(data: xr.Dataset) -> Figure:
    figure, panels = new_panels(2, 2, (7.2, 5.8), sharex=True, sharey=True)
    n = np.linspace(1, 4.2, 100)
    names = {"wave": "a wave, no free surface", "slump": "a slump"}
    for (scene, velocity), axes in zip(itertools.product(SCENES, VELOCITIES), panels.flat, strict=True):
        axes.set_title(f"{names[scene]}, {velocity.upper()}", fontsize=9, loc="left")
        for (j, shape), (i, order) in itertools.product(enumerate(SHAPES), enumerate(ORDERS)):
            one = data.sel(scene=scene, velocity=velocity, shape=shape, order=order)
            x = one.per_axis + 0.09 * (i - 1) + 0.3 * (j - 0.5)
            low = np.maximum(one.stable, 0.05)
            high = np.where(np.isfinite(one.unstable), one.unstable, low * 1.06)
            face = COLOURS[order] if shape == "cpgimp" else "white"
            axes.vlines(x, low, high, color=COLOURS[order], linewidth=1)
            axes.plot(x, low, "os"[j], color=COLOURS[order], markerfacecolor=face, markersize=4.5)
        for order in ("usl", "usf") if scene == "wave" else ():
            axes.plot(n, theory(velocity, order, n), color=COLOURS[order], linewidth=1, zorder=1)
        if scene == "slump":
            surface = np.minimum(1 / np.sqrt(n), theory("flip", "usl", n))
            axes.plot(n, surface, "--", color=COLOURS["usl"], linewidth=1, zorder=1)
        for part in (0.4, 1.0) if velocity == "flip" else (0.4,):
            axes.axhline(part, color="black", linewidth=0.8, linestyle=":", zorder=0)
        axes.set(yscale="log", ylim=(0.045, 2.6), xlim=(0.6, 4.4), xticks=PER_AXIS)
        axes.set_yticks([0.05, 0.1, 0.2, 0.4, 0.7, 1, 2], ["0.05", "0.1", "0.2", "0.4", "0.7", "1", "2"])
        axes.minorticks_off()
    for axes in panels[1]:
        axes.set_xlabel("particles per cell and axis")
    for axes in panels[:, 0]:
        axes.set_ylabel("largest stable step / (dx/c)")
    handles = [axes.plot([], [], "s", color=c, label=f"{o.upper()}, cpGIMP")[0] for o, c in COLOURS.items()]
    handles += [
        axes.plot([], [], "o", color=c, markerfacecolor="white", label=f"{o.upper()}, linear")[0]
        for o, c in COLOURS.items()
    ]
    handles += [
        axes.plot([], [], "-", color="grey", label="theory, inside a body")[0],
        axes.plot([], [], "--", color=COLOURS["usl"], label="USL at a free surface, √w")[0],
        axes.plot([], [], ":", color="black", label="what the schemes take at most")[0],
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure


if __name__ == "__main__":
    make("acoustic", measure, draw)
