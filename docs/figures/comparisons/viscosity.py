"""Draw docs/images/comparisons/viscosity.png: T500 over the plastic viscosity, theory and a correlation.

    for name in viscosity viscosity_fine; do mpmkit study cases/studies/$name.json; done
    python docs/figures/comparisons/viscosity.py

The studies take about eight minutes of one core, the figure two seconds; with --draw it needs no runs.
"""

import numpy as np
from closed_forms import spread_stick, t500_of_sedran, t500_slip
from shared import BLUE, ORANGE, RED, data, panels, save, say
from thin_film import t500_film

DENSITY = 2574
YIELD, VISCOSITY = "bodies.0.material.yield_stress", "bodies.0.material.plastic_viscosity"


def main() -> None:
    names = ["t500", "final_spread", "final_slump"]
    runs, fine = data(viscosity=names, viscosity_fine=names)
    sheet, plots = panels(2, "T500 of a Bingham fluid over its plastic viscosity")
    viscosity = np.linspace(0, 210, 50)
    for plot, stress in zip(plots, runs[YIELD].values, strict=True):
        spread = float(spread_stick(float(stress), DENSITY))
        lines = (
            (viscosity * t500_film(float(stress), DENSITY), "k--", "thin film, stick"),
            (t500_of_sedran(viscosity, spread, DENSITY), "k-", f"Sedran & de Larrard, {1e3 * spread:.0f} mm"),
            (t500_slip(viscosity, float(stress), DENSITY), "k:", "uniform sheet, slip"),
        )
        for times, style, label in lines:
            plot.plot(viscosity, times, style, lw=1, label=label)
        there = runs[VISCOSITY].astype(float)
        for found, color, label in (
            (fine.t500.sel({YIELD: stress}), ORANGE, "mpmkit, stick, 5 mm"),
            (runs.t500.sel({"floor": "stick", YIELD: stress}), RED, "mpmkit, stick, 10 mm"),
            (runs.t500.sel({"floor": "slip", YIELD: stress}), BLUE, "mpmkit, slip, 10 mm"),
        ):
            plot.plot(there, found, "o", color=color, ms=4, label=label)
        plot.set(xlim=(0, 210), ylim=(0, 10))
        say(plot, f"Yield stress {stress} Pa", "plastic viscosity / (Pa s)", "T500 / s")
        plot.legend(frameon=False, fontsize=7, loc="upper left")
    save(sheet, "viscosity")


if __name__ == "__main__":
    main()
