"""Draw docs/images/stability/energy_drift.png: the energy that update orders make or lose, by step and cells.

    python docs/figures/stability/energy_drift.py [--draw]

Takes about two minutes.
"""

from collections.abc import Iterator

import numpy as np
import xarray
from maps import BLACK, BLUE, GREEN, GREY, VERMILION, make, sheet
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from swings import BAR_SPEED, LENGTH, bar, block, discs

import mpmkit
from mpmkit.errors import GuardStop

FRACTIONS = 0.8 / 2.0 ** np.arange(9)
ORDERS = {"usf": BLUE, "musl": GREEN, "usl": VERMILION}
SCENES = {
    # until, length of the windows at either end in which the energy is averaged, least fraction, cells
    "bar": (100.0, 10.0, 0.01, (13, 25)),
    "discs": (3.4, 0.2, 0.01, (8, 16)),
    "block": (0.48, 0.12, 0.003, (6, 12)),
}
TITLES = {
    "bar": "Vibrating bar, {} and {} cells",
    "discs": "Two discs, {} and {} cells across",
    "block": "Inviscid block, {} and {} cells",
}


def energies(simulation: mpmkit.Simulation, until: float) -> Iterator[tuple[float, float]]:
    every = max(1, int(until / 1000 / simulation.time_step))
    while simulation.time < until * (1 - 1e-9):
        if simulation.steps % every == 0:
            found = simulation.measures(simulation.particles)
            parts = ("kinetic_energy", "strain_energy", "compressive_energy")
            yield simulation.time, sum(float(found[part]) for part in parts)
        simulation.advance(until - simulation.time)


def drift(scene: str, cells: int, order: str, fraction: float) -> float:
    """Mean energy at the end over that at the start, less one; not a number if it diverges."""
    until, window, least, _ = SCENES[scene]
    if fraction < least:
        return np.nan
    case = {"bar": bar, "discs": discs, "block": block}[scene](cells)
    case["scheme"]["order"] = order
    try:
        with np.errstate(all="ignore"):
            simulation = mpmkit.Simulation(mpmkit.parse_case(case), fraction=fraction)
            time, energy = np.array(list(energies(simulation, until))).T
    except GuardStop:
        return np.nan
    change = energy[time > until - window].mean() / energy[time < window].mean() - 1
    return change if change < 1 else np.nan


def lost_by_usl(cells: int, fraction: np.ndarray) -> np.ndarray:
    """Theory of the page for the bar, in the nine periods between the middles of the windows."""
    at_the_tip = 2 * fraction * BAR_SPEED / LENGTH * (np.pi / (4 * cells)) ** 2
    inside = at_the_tip * np.pi**2 / (8 * cells)
    return -np.expm1(-90.0 * (at_the_tip + inside))


def measure() -> xarray.Dataset:
    found = [
        [[[drift(scene, n, order, f) for f in FRACTIONS] for order in ORDERS] for n in cells]
        for scene, (*_, cells) in SCENES.items()
    ]
    what = {"units": "1", "long_name": "mean energy at the end over that at the start, less one"}
    return xarray.Dataset(
        {"drift": (("scene", "grid", "order", "fraction"), found, what)},
        {
            "scene": list(SCENES),
            "grid": ["coarse", "fine"],
            "order": list(ORDERS),
            "fraction": ("fraction", FRACTIONS, {"units": "1", "long_name": "time step over dx/c"}),
        },
    )


def draw(data: xarray.Dataset) -> Figure:
    figure, panels = sheet("Energy created (▲) or lost (▼), by time step and cells", 3, width=11.2)
    for axes, (scene, (*_, cells)) in zip(panels, SCENES.items(), strict=True):
        for grid, number, dashes in zip(data.grid.values, cells, ("-", ":"), strict=True):
            for order, colour in ORDERS.items():
                change = data.drift.sel(scene=scene, grid=grid, order=order)
                axes.plot(data.fraction, abs(change), dashes, color=colour, lw=1)
                for sign, marker in ((1, "^"), (-1, "v")):
                    fill = colour if grid == "coarse" else "white"
                    of_sign = change.where(sign * change > 0)
                    axes.plot(data.fraction, abs(of_sign), marker, color=colour, mfc=fill, ms=5)
            if scene == "bar":
                axes.plot(FRACTIONS[:7], lost_by_usl(number, FRACTIONS[:7]), dashes, color=BLACK, lw=1.4)
            if scene == "block":  # where the stress at the surface lives as long as a swing
                turn = np.pi / (8 * number)
                axes.plot([turn, turn], [2e-3, 0.3], dashes, color=GREY, lw=1.2)
        axes.set(xscale="log", yscale="log", xlim=(0.0025, 1), ylim=(3e-7, 0.4), xlabel="time step over Δx/c")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_title(TITLES[scene].format(*cells), fontsize=9)
    panels[0].set_ylabel("relative change of the mean energy")
    panels[2].plot([], [], "-", color=GREY, label="ω × life of the stress = 1")
    panels[1].plot(FRACTIONS[2:7], 0.6 * FRACTIONS[2:7], "--", color=BLACK, lw=1, label="as the step")
    panels[0].plot([], [], "-", color=BLACK, lw=1.4, label="USL, theory")
    for order, colour in ORDERS.items():
        panels[0].plot([], [], "o-", color=colour, ms=4, label=order.upper())
    panels[1].plot([], [], "o-", color=BLACK, ms=4, lw=1, label="fewer cells")
    panels[1].plot([], [], "o:", color=BLACK, mfc="white", ms=4, lw=1, label="more cells")
    for axes in panels:
        axes.legend(frameon=False, fontsize=8, loc="lower left" if axes is panels[2] else "lower right")
    return figure


if __name__ == "__main__":
    make("energy_drift", measure, draw)
