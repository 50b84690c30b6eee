"""Draw docs/images/stability/pressure_mode.png: what averaged volumes do not see, and what comes of it.

    python docs/figures/stability/pressure_mode.py [--draw]

Takes about three minutes, most of them for the tanks.
"""

from collections.abc import Iterator

import numpy as np
import xarray
from maps import BLACK, BLUE, DOCS, GREEN, ORANGE, PURPLE, SKY, VERMILION, make, sheet
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from tank import PERIODS, ROWS, TANKS, heights

import mpmkit

RATES = (0.0, 0.1, 1.0, 10.0)
COLOURS = dict(zip(("own", *RATES), (BLACK, VERMILION, ORANGE, GREEN, BLUE), strict=True))
SLUMP_UNTIL = 1.5
GROWS = 5.0
"""Cells crossed in which the unseen part of J grows freely."""
TANK_COLOURS = (
    *(BLACK, VERMILION, GREEN, BLUE),
    *(PURPLE, ORANGE, SKY, GREEN, VERMILION),
    *(BLACK, BLUE, ORANGE, VERMILION, GREEN),
)


def unseen(simulation: mpmkit.Simulation) -> float:
    """Root mean square of J less its average over the grid, by initial volume."""
    p, operations = simulation.particles, simulation.operations
    operations.begin()
    measure, volume = p.volume.copy(), p.initial_volume
    p.volume[:] = volume  # the average by initial volume, as the relaxation takes it
    off = p.volume_ratio - operations.average(p.volume_ratio)
    p.volume[:] = measure
    return float(np.sqrt(np.sum(volume * off**2) / np.sum(volume)))


def slump(volumes: str | float) -> Iterator[tuple[float, float, float]]:
    """Cells that the material has crossed, what of J is unseen, and spread, m."""
    treatment = f'{{"name": "nodal-average", "relaxation": {volumes}}}' if volumes != "own" else "own"
    case = mpmkit.load_case(
        DOCS.parent / "cases/slump.json",
        [
            "grid.cell_size=0.01",
            'grid.domain={"r": [0, 0.36], "z": [0, 0.31]}',
            f"scheme.volumetric={treatment}",
            "scheme.redistribution=none",
            "scheme.splitting=true",
        ],
    )
    simulation, crossed = mpmkit.Simulation(case), 0.0
    for time in np.linspace(0, SLUMP_UNTIL, ROWS):
        while simulation.time < time * (1 - 1e-12):
            step = simulation.advance(time - simulation.time)
            crossed += simulation.operations.mean_speed * step / simulation.grid.cell_size
        yield crossed, unseen(simulation), simulation.measures(simulation.particles)["spread_diameter"]


def measure() -> xarray.Dataset:
    slumps = np.array([list(slump(volumes)) for volumes in COLOURS])
    tanks = [list(heights(scheme, settings)) for scheme, _, settings in TANKS.values()]
    where = ("volumes", "row")
    return xarray.Dataset(
        {
            "crossed": (
                where,
                slumps[..., 0],
                {"units": "1", "long_name": "cells that the slump has crossed"},
            ),
            "unseen": (where, slumps[..., 1], {"units": "1", "long_name": "rms of J less its average"}),
            "spread": (where, slumps[..., 2], {"units": "m", "long_name": "spread"}),
            "height": (
                ("tank", "row"),
                tanks,
                {"units": "1", "long_name": "centre of mass over that at rest"},
            ),
        },
        {
            "volumes": [str(volumes) for volumes in COLOURS],
            "tank": list(TANKS),
            "time": (
                "row",
                np.linspace(0, SLUMP_UNTIL, ROWS),
                {"units": "s", "long_name": "time of the slump"},
            ),
            "period": (
                "row",
                np.linspace(0, PERIODS, ROWS),
                {"units": "1", "long_name": "periods of the tank"},
            ),
        },
    )


def draw(data: xarray.Dataset) -> Figure:
    figure, (left, right) = sheet("Variations of J that averaged volumes do not see", 2, width=11.2)
    draw_slump(left, data)
    for (name, (_, dashes, _)), colour in zip(TANKS.items(), TANK_COLOURS, strict=True):
        right.plot(data.period, data.height.sel(tank=name), dashes, color=colour, lw=1.4, label=name)
    right.set(
        xlim=(0, PERIODS),
        ylim=(0.3, 1.05),
        xlabel="periods",
        ylabel="height of the centre of mass over that at rest",
    )
    right.set_title("Height of an oscillating fluid in a tank", fontsize=9)
    right.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def draw_slump(axes: Axes, data: xarray.Dataset) -> None:
    for volumes, colour in zip(data.volumes.values, COLOURS.values(), strict=True):
        own = volumes == "own"
        label = "own" if own else f"averaged, relaxation {float(volumes):g}"
        at = data.sel(volumes=volumes)
        axes.semilogy(at.crossed, 100 * at.unseen, color=colour, lw=1.4, label=label)
        if not own:
            axes.semilogy(at.crossed, 100 * expected(data, float(volumes)), "--", color=colour, lw=1)
    axes.plot([], [], "--", color=BLACK, lw=1, label="theory")
    axes.set(
        xlim=(0, 20),
        ylim=(1e-3, 2),
        xlabel="cells crossed",
        ylabel="J minus its average, RMS / %",
    )
    axes.set_title("Slump, cells of 10 mm", fontsize=9)
    axes.legend(frameon=False, fontsize=8, ncols=2, loc="upper left")


def expected(data: xarray.Dataset, rate: float) -> np.ndarray:
    """Root of the square that d(square)/dN = q - 2 rate square gives, N cells crossed; q is what it grows by
    in the first cells of the run without relaxation."""
    crossed, free = data.crossed.sel(volumes="0.0").values, data.unseen.sel(volumes="0.0").values
    first = np.searchsorted(crossed, GROWS)
    q = free[first] ** 2 / crossed[first]
    return np.sqrt(q * crossed if rate == 0 else q / (2 * rate) * -np.expm1(-2 * rate * crossed))


if __name__ == "__main__":
    make("pressure_mode", measure, draw)
