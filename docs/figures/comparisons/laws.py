"""Draw docs/images/comparisons/laws.png: Bingham against Herschel-Bulkley, exact yield against regularised.

    mpmkit study cases/studies/laws.json && python docs/figures/comparisons/laws.py

The study takes about six minutes of one core, the figure a second; with --draw it needs no runs.
"""

import numpy as np
from closed_forms import VOLUME
from shared import BLUE, GREEN, ORANGE, RED, SKY, data, panels, reference, save, say

YIELD, CONSISTENCY, INDEX, WEIGHT = 188.91, 45.65, 1.33, 2574 * 9.81
VISCOSITIES = {"Bingham, exact": (85.32, RED), "Bingham through 5 /s, exact": (77.64, ORANGE)}
EXACT = {"Herschel-Bulkley, exact": BLUE, "Bingham, exact": RED, "Bingham through 5 /s, exact": ORANGE}
REGULARISED = {10: GREEN, 100: SKY, 1000: "#CC79A7"}
"""Exponent m, s, and how it is drawn."""
ACROSS = 10  # rows of the history, 0.3 s, over which a rate is taken


def main() -> None:
    (laws,) = data(laws=["spread_diameter", "t500", "final_spread", "final_height"])
    sheet, (curves, spreads, rates) = panels(3, "Slump with one flow curve by four laws, 10 mm")

    rate = np.geomspace(1e-3, 20, 300)
    power = CONSISTENCY * rate**INDEX
    curves.axvspan(0.1, 10, color="k", alpha=0.07, lw=0, label="range of the fit")
    curves.plot(rate, YIELD + power, color=BLUE, label="Herschel-Bulkley")
    for name, (viscosity, color) in VISCOSITIES.items():
        curves.plot(rate, YIELD + viscosity * rate, color=color, ls="--", label=name.removesuffix(", exact"))
    for m in (10, 100):
        label = f"Herschel-Bulkley, m = {m} s"
        curves.plot(rate, -YIELD * np.expm1(-m * rate) + power, color=REGULARISED[m], ls=":", label=label)
    curves.set(xscale="log", yscale="log", xlim=(1e-3, 20), ylim=(1, 2e4))
    say(curves, "Flow curves", "shear rate / (1/s)", "shear stress / Pa")

    time, exact = reference()
    spreads.plot(time, 1e3 * exact, "k--", lw=1, label="finite elements, Herschel-Bulkley")
    for name, color in EXACT.items():
        spreads.plot(laws.time, 1e3 * laws.spread_diameter.sel(member=name), color=color, label=name)
    spreads.axhline(500, color="k", lw=0.6)
    spreads.set(xlim=(0, 2), ylim=(180, 600))
    say(spreads, "Exact yield", "time / s", "spread diameter / mm")

    for name, color in EXACT.items():
        draw_rate(rates, laws, name, color=color, label=name)
    for m, color in REGULARISED.items():
        name = f"Herschel-Bulkley, m = {m} s, relaxed"
        draw_rate(rates, laws, name, color=color, label=name.removesuffix(", relaxed"))
        start = float(laws.spread_diameter.sel(member=name).interp(time=2.5))
        times, spread = sheet_that_creeps(start, m)
        rates.plot(times, 1e3 * np.gradient(spread, times), "k:", lw=1, label="uniform sheet" * (m == 1000))
    rates.set(yscale="log", xlim=(0.5, 6), ylim=(0.02, 1e4))
    say(rates, "Creep after the slump", "time / s", "rate of the spread / (mm/s)")

    for plot, where in ((curves, "upper left"), (spreads, "lower right"), (rates, "upper right")):
        plot.legend(frameon=False, fontsize=7, loc=where)
    save(sheet, "laws")


def draw_rate(plot, laws, name: str, **style) -> None:
    spread, time = 1e3 * laws.spread_diameter.sel(member=name).values, laws.time.values
    rate = (spread[ACROSS:] - spread[:-ACROSS]) / (time[ACROSS:] - time[:-ACROSS])
    plot.plot((time[ACROSS:] + time[:-ACROSS]) / 2, np.where(rate > 0.02, rate, np.nan), **style)


def sheet_that_creeps(spread: float, m: float) -> tuple[np.ndarray, np.ndarray]:
    """A uniform sheet on a slip floor below its yield stress, from 2.5 s on, without inertia.

    tau = rho g H/(2 √3) = tau0 (1 - exp(-m γ̇)) gives γ̇ = 2 √3 e, and dD/dt = e D.
    """
    times = np.linspace(2.5, 6, 351)
    found = [spread]
    for step in np.diff(times):
        height = 4 * VOLUME / (np.pi * found[-1] ** 2)
        shear = -np.log1p(-WEIGHT * height / (2 * np.sqrt(3) * YIELD)) / m
        found.append(found[-1] * (1 + step * shear / (2 * np.sqrt(3))))
    return times, np.array(found)


if __name__ == "__main__":
    main()
