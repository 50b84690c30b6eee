"""Draw docs/images/stability/long_shear.png: a film and a tank with a large shear.

    python docs/figures/stability/long_shear.py [--draw]

Takes about six minutes.
"""

from collections.abc import Iterator

import numpy as np
import xarray
from maps import BLACK, BLUE, GREEN, ORANGE, VERMILION, make, sheet
from matplotlib.figure import Figure
from shear_scenes import (
    ANGLE,
    BLOCK,
    CELLS,
    FILM_UNTIL,
    MORTAR,
    TANK,
    TANK_UNTIL,
    THICK,
    down_slope,
    film,
    tank,
)

import mpmkit

NONE = {"redistribution": "none"}
SCHEMES: dict[str, dict] = {
    "none": NONE,
    "none, splitting": NONE | {"splitting": True},
    "none, fixed boxes": NONE | {"shape": {"name": "cpgimp", "domain": "fixed"}},
    "none, own, FLIP": NONE | {"volumetric": "own", "velocity": "flip"},
    "even": {},
}
COLOURS = dict(zip(SCHEMES, (VERMILION, ORANGE, GREEN, BLACK, BLUE), strict=True))
ROWS = 121


def rows(simulation: mpmkit.Simulation, until: float) -> Iterator[tuple[float, float, float]]:
    """Of the particles, by mass: mean speed along x, m/s, and height, m; and the density inside, 1.

    Not a number from the moment at which a guard stops the run.
    """
    stopped = False
    for time in np.linspace(0, until, ROWS):
        try:
            while not stopped and simulation.time < time * (1 - 1e-12):
                simulation.advance(time - simulation.time)
        except mpmkit.errors.GuardStop as stop:
            print(stop)
            stopped = True
        if stopped:
            yield (np.nan,) * 3
        else:
            p = simulation.particles
            speed, height = (np.average(a, weights=p.mass) for a in (p.velocity[:, 0], p.position[:, 1]))
            yield float(speed), float(height), float(simulation.measures(p)["density_mean"])


def measure() -> xarray.Dataset:
    films = np.array([list(rows(film(scheme), FILM_UNTIL)) for scheme in SCHEMES.values()])
    tanks = np.array([list(rows(tank(scheme), TANK_UNTIL)) for scheme in SCHEMES.values()])
    drive, _ = down_slope(MORTAR.density, ANGLE)
    exact = MORTAR.half_discharge(drive, THICK) / THICK
    flat = BLOCK[0] * BLOCK[1] / TANK[0] / 2
    time = np.linspace(0, FILM_UNTIL, ROWS)
    # The mean shear of the exact film, so that all schemes have one abscissa.
    found = {
        "speed": (films[..., 0] / exact, "mean speed over exact"),
        "film_density": (films[..., 2], "density inside over the material's own"),
        "height": (tanks[..., 1] / flat, "centre of mass over that of the flat pool"),
    }
    return xarray.Dataset(
        {
            name: (("scheme", "row"), values, {"units": "1", "long_name": text})
            for name, (values, text) in found.items()
        },
        {
            "scheme": list(SCHEMES),
            "shear": (
                "row",
                exact * time / THICK,
                {"units": "1", "long_name": "mean displacement over thickness"},
            ),
            "tank_time": ("row", np.linspace(0, TANK_UNTIL, ROWS), {"units": "s", "long_name": "time"}),
        },
    )


def draw(data: xarray.Dataset) -> Figure:
    figure, (speeds, densities, heights) = sheet(
        f"Long shear: a Bingham film on {ANGLE:g}°, {CELLS} cells thick; a block released in a closed tank",
        3,
        width=12.6,
    )
    for name in data.scheme.values:
        one, look = data.sel(scheme=name), {"color": COLOURS[str(name)], "label": str(name), "lw": 1.4}
        speeds.plot(data.shear, one.speed, **look)
        densities.plot(data.shear, one.film_density, **look)
        heights.plot(data.tank_time, one.height, **look)
    for axes, text in (
        (speeds, "mean speed / exact"),
        (densities, "density inside / material's own"),
        (heights, "centre of mass / flat pool"),
    ):
        axes.axhline(1.0, color="black", lw=0.8, ls=":")
        axes.set_ylabel(text)
    speeds.set_xlabel("film: mean displacement / thickness")
    densities.set_xlabel("film: mean displacement / thickness")
    heights.set_xlabel("tank: time, s")
    speeds.set_ylim(0.0, 1.6)
    heights.set_ylim(0.5, 1.5)
    speeds.legend(fontsize=8)
    return figure


if __name__ == "__main__":
    make("long_shear", measure, draw)
