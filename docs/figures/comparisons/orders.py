"""Draw docs/images/comparisons/orders.png: USL, USF and MUSL on a slump, a bar and two discs.

    for name in slump bar discs; do mpmkit study cases/studies/schemes_$name.json; done
    python docs/figures/comparisons/orders.py

The studies take about four minutes of one core, the figure a second; with --draw it needs no runs.
"""

import math

import numpy as np
import xarray
from shared import ORDERS, data, panels, save, say

CONTACT = 1.586  # s, of rigid discs
INITIAL = 2.5133  # J, kinetic energy of the discs
CELL, SPEED, PERIOD = 25 / 13, 10.0, 10.0
"""Of the bar: cell, m, speed of waves, m/s, and the period, s; half of it where both ends are held."""
STEP = 0.1 * CELL / SPEED
ENDS = {
    "free": ("13 cells, 1 particle", math.pi / 50, {}),
    "held": ("13 cells, both ends held", math.pi / 25, {"alpha": 0.5}),
}
"""By its far end: the bar's name in the study, its wave number, 1/m, and how it is drawn."""


def main() -> None:
    slump, bar, discs = data(
        schemes_slump=["spread_diameter", "t500", "final_spread"],
        schemes_bar=["kinetic_energy", "strain_energy"],
        schemes_discs=["kinetic_energy", "strain_energy"],
    )
    sheet, (spread, energy, kinetic) = panels(3, "Update orders, cpGIMP")

    for step, width in (("0.4", 1.8), ("0.1", 0.8)):
        runs = slump.spread_diameter.sel(cells="10 mm", step=step, shape="cpGIMP")
        for order in ("USF", "MUSL"):
            apart = 1e3 * (runs.sel(order=order) - runs.sel(order="USL"))
            spread.plot(slump.time, apart, lw=width, label=f"{order}, step {step}", **ORDERS[order])
    say(spread, "Slump, 10 mm", "time / s", "spread minus that of USL / mm")
    spread.set_ylim(-0.15, 0.8)
    spread.legend(frameon=False, fontsize=8, ncols=2, loc="upper left")

    total = (bar.kinetic_energy + bar.strain_energy).sel(shape="cpGIMP")
    for end, (cells, wave, style) in ENDS.items():
        for order in ("USL",) if end == "held" else ("USL", "USF", "MUSL"):
            run = total.sel(cells=cells, order=order)
            times, energies = means(run)
            energy.plot(times, energies / energies[0], label=f"{order}, {end} end", **(ORDERS[order] | style))
        lost = (wave * CELL / 2) ** 2 * (wave * SPEED) ** 2 * STEP
        energy.plot(
            times, np.exp(-lost * (times - times[0])), "k", lw=0.8, label=f"USL, theory, {end}", **style
        )
    say(energy, "Vibrating bar, 13 cells", "time / s", "mean energy of a period over the first")
    energy.legend(frameon=False, fontsize=7, loc="lower left")

    for order, style in ORDERS.items():
        run = discs.kinetic_energy.sel(cells="50 mm", shape="cpGIMP", order=order)
        kinetic.plot(discs.time, run / INITIAL, label=order, **style)
    kinetic.axvline(CONTACT, color="k", lw=0.8, ls="-.", label="rigid discs touch")
    say(kinetic, "Two discs, 50 mm", "time / s", "kinetic energy over the initial one")
    kinetic.legend(frameon=False, fontsize=8, loc="lower left")
    kinetic.set_xlim(-0.1, 3.05)
    save(sheet, "orders")


def means(run: xarray.DataArray) -> tuple[np.ndarray, np.ndarray]:
    """Means over PERIOD, each at its middle."""
    rows = int(np.searchsorted(run.time, PERIOD))
    whole = len(run) // rows * rows
    times, energies = (
        values[:whole].reshape(-1, rows).mean(axis=1) for values in (run.time.values, run.values)
    )
    return times, energies


if __name__ == "__main__":
    main()
