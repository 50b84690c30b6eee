"""Draw docs/images/stability/locking.png: the spread of a slump against the sound speed.

    mpmkit study cases/studies/locking.json --workers 1
    python docs/figures/stability/locking.py [--draw]

Takes about five minutes, nearly all of them for the study, and half a minute for the references.
"""

import numpy as np
import xarray
from maps import BLACK, BLUE, DOCS, GREEN, GREY, ORANGE, VERMILION, make, sheet
from matplotlib.figure import Figure

import mpmkit

RESULTS = DOCS.parent / "runs/locking/results.nc"
PARTICLES = "bodies.0.particles_per_cell"
FINE = [
    "until=1",
    "grid.cell_size=0.01",
    'grid.domain={"r": [0, 0.36], "z": [0, 0.31]}',
    'bodies.0.material.sound_speed={"factor": 20}',
    "bodies.0.particles_per_cell=9",
]
"""The references: half the cell, averaged volumes."""
BEFORE = 0.2
"""Spread of the cone, m."""


def measure() -> xarray.Dataset:
    with xarray.open_dataset(RESULTS) as results:
        spread = results.spread_diameter.isel(time=-1).load().rename({PARTICLES: "particles"})
    spread = spread.assign_coords(
        particles=[int(label) for label in spread.particles.values],
        sound=[float(label) for label in spread.sound.values],
    )
    fine = [
        float(
            mpmkit.run(
                mpmkit.load_case(DOCS.parent / "cases/slump.json", [*FINE, f"grid.faces.z_min={floor}"])
            ).spread_diameter[-1]
        )
        for floor in spread.floor.values
    ]
    found = xarray.Dataset({"spread": spread.drop_vars("time"), "reference": ("floor", fine)})
    found.spread.attrs = {"units": "m", "long_name": "spread at 1 s"}
    found.reference.attrs = {"units": "m", "long_name": "spread at 1 s, cells of 10 mm, averaged volumes"}
    found.sound.attrs = {"units": "1", "long_name": "sound speed over √(2 g h)"}
    found.particles.attrs = {"units": "1", "long_name": "particles per cell at the start"}
    return found


def draw(data: xarray.Dataset) -> Figure:
    figure, panels = sheet("Locking: slump at 1 s, cells of 20 mm, over the reference (10 mm, averaged)", 2)
    sound = data.sound
    for axes, floor in zip(panels, ("stick", "slip"), strict=True):
        reference = data.reference.sel(floor=floor)
        for particles, colour in zip(data.particles.values, (GREY, ORANGE, GREEN, BLUE), strict=True):
            for volumes, style in (("averaged", "o-"), ("own", "s--")):
                at = data.spread.sel(floor=floor, volumes=volumes, particles=particles) / reference
                label = f"{particles} per cell, {volumes}"
                axes.plot(sound, at, style, color=colour, mfc="white", lw=1.2, ms=5, label=label)
        axes.set(xscale="log", xticks=[2, 5, 10, 20, 50], xticklabels=["2", "5", "10", "20", "50"])
        axes.minorticks_off()
        axes.set_xlabel("sound speed over √(2 g h)")
        axes.set_title(f"Floor: {floor}", fontsize=9)
    stick, slip = panels
    factor = np.geomspace(2, 50, 100)
    held = BEFORE / data.reference.sel(floor="stick").item()
    stick.plot(factor, held * (1 + 1 / factor**2), color=VERMILION, lw=1.5, label="locked, theory")
    stick.axhline(held, color=BLACK, lw=0.8, ls=":", label="initial cone")
    stick.set(ylim=(0.4, 1.45), ylabel="spread over the reference")
    slip.set(ylim=(0.95, 1.02))
    stick.legend(frameon=False, fontsize=8, ncols=2, loc="upper right")
    return figure


if __name__ == "__main__":
    make("locking", measure, draw)
