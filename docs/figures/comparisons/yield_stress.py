"""Draw docs/images/comparisons/yield_stress.png: slump and spread over the yield stress, beside closed forms.

    for name in yield_stress yield_stress_slow viscosity; do mpmkit study cases/studies/$name.json; done
    python docs/figures/comparisons/yield_stress.py

The studies take about fifteen minutes of one core, the figure a second; with --draw it needs no runs.
"""

import numpy as np
import xarray
from closed_forms import (
    GRAVITY,
    HEIGHT,
    MISES,
    TRESCA,
    height_slip,
    height_stick,
    slump_of_cylinder,
    slump_of_layers,
    slump_of_roussel,
    slump_tall,
    spread_slip,
    spread_stick,
)
from shared import BLUE, GREEN, RED, data, panels, save, say

DENSITY = 2574
YIELD, VISCOSITY = "bodies.0.material.yield_stress", "bodies.0.material.plastic_viscosity"
STANDS = {"slip": 0.320, "stick": 0.266}
"""Yield stress over rho g H at which the cone stands by itself (validation, section 4)."""
FINAL = ["final_spread", "final_slump"]


def main() -> None:
    fast, slow, thin = data(yield_stress=FINAL, yield_stress_slow=FINAL, viscosity=["t500", *FINAL])
    fast, cone = fast.sel(cells="10 mm"), slow.sel(body="cone")
    sheet, (slip, stick, spread, cylinder) = panels(2, "Slump test at rest, over the yield stress", rows=2)
    stress = np.geomspace(10, 5000, 400)

    for plot, floor, rest in ((slip, "slip", height_slip), (stick, "stick", height_stick)):
        line(plot, stress, slump_of_layers(stress, DENSITY, TRESCA), "-", "layers, Tresca: Murata")
        line(plot, stress, slump_of_layers(stress, DENSITY, MISES), "--", "layers, von Mises")
        name = "uniform sheet" if floor == "slip" else "sheet: Roussel & Coussot"
        line(plot, stress, HEIGHT - rest(stress, DENSITY), ":", name)
        points(plot, "final_slump", floor, BLUE if floor == "slip" else RED, at_once=fast, slowly=cone)
        plot.axvline(STANDS[floor] * DENSITY * GRAVITY * HEIGHT, color="k", lw=0.6, alpha=0.5)
    line(slip, stress, slump_tall(stress, DENSITY), "-.", "tall: Roussel & Coussot")
    roussel = slump_of_roussel(stress, DENSITY)
    line(stick, stress, np.where(roussel > 0.05, roussel, np.nan), "-.", "Roussel 2006")
    bingham = thin.final_slump.sel({"floor": "stick", VISCOSITY: "20"})
    stick.plot(bingham[YIELD].astype(float), 1e3 * bingham, "x", color=GREEN, ms=5, label="Bingham, 20 Pa s")

    line(spread, stress, spread_slip(stress, DENSITY), ":", "uniform sheet, slip")
    line(spread, stress, spread_stick(stress, DENSITY), "--", "Roussel & Coussot, stick")
    points(spread, "final_spread", "slip", BLUE, slip=fast)
    points(spread, "final_spread", "stick", RED, stick=fast)
    bingham = thin.final_spread.sel({"floor": "stick", VISCOSITY: "20"})
    spread.plot(bingham[YIELD].astype(float), 1e3 * bingham, "x", color=GREEN, ms=5, label="stick, 20 Pa s")

    line(cylinder, stress, slump_of_cylinder(stress, DENSITY, HEIGHT), "-", "layers, Tresca: Pashias")
    line(cylinder, stress, slump_of_cylinder(stress, DENSITY, HEIGHT, MISES), "--", "layers, von Mises")
    line(cylinder, stress, HEIGHT - height_slip(stress, DENSITY), ":", "uniform sheet, slip")
    points(cylinder, "final_slump", "slip", BLUE, slip_slowly=slow.sel(body="cylinder"))
    points(cylinder, "final_slump", "stick", RED, stick_slowly=slow.sel(body="cylinder"))

    titles = ("Slump, slip floor", "Slump, stick floor", "Spread, released at once", "Slump of a cylinder")
    for plot, title in zip((slip, stick, spread, cylinder), titles, strict=True):
        say(plot, title, "yield stress / Pa", ("spread diameter" if plot is spread else "slump") + " / mm")
        plot.set(xscale="log", xlim=(10, 5000))
        if plot is not spread:
            plot.set_ylim(0, 310)
        plot.legend(frameon=False, fontsize=7, loc="upper right" if plot is spread else "lower left")
    spread.set(ylim=(150, 2500), yscale="log")
    spread.set_yticks([200, 300, 500, 1000, 2000], ["200", "300", "500", "1000", "2000"])
    spread.minorticks_off()
    save(sheet, "yield_stress")


def line(plot, stress: np.ndarray, values: np.ndarray, dashes: str, label: str) -> None:
    plot.plot(stress, 1e3 * values, dashes, color="k", lw=1, label=label)


def points(plot, name: str, floor: str, color: str, **runs: xarray.Dataset) -> None:
    """Simulations on a floor, each under its label."""
    for label, found in runs.items():
        marker = "+" if "slowly" in label else "o"
        style = {"color": color, "ms": 6 if marker == "+" else 4, "label": label.replace("_", " ")}
        plot.plot(found[YIELD].astype(float), 1e3 * found[name].sel(floor=floor), marker, **style)


if __name__ == "__main__":
    main()
