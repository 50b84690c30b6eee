"""Draw docs/images/comparisons/torque.png: torque of a coaxial cylinder rheometer against its speed.

    mpmkit study cases/studies/torque.json
    python docs/figures/comparisons/torque.py

The study takes about a quarter of a minute of one core, the figure a second; with --draw it needs no runs.
"""

import math

import numpy as np
from shared import BLUE, ORANGE, RED, data, panels, save, say

from mpmkit.case.load import read_json
from mpmkit.case.parameters import parameters
from mpmkit.case.shipped import shipped_case
from mpmkit.rheology.laboratory import FORMULAS

CASE = "coaxial_cylinders"
WIDEST = 1.5
"""Turns per second up to which the figure goes."""


def main() -> None:
    (runs,) = data(torque=["torque_of_cylinder"])
    given = {key: entry.value for key, entry in parameters(read_json(shipped_case(CASE))).items()}
    turns = np.array([float(str(speed).split()[0]) for speed in runs.speed.values])
    found = np.array([steady(runs.torque_of_cylinder.sel(speed=speed)) for speed in runs.speed.values])
    said = exact(given, turns)
    for speed, torque, formula in zip(turns, found, said, strict=True):
        print(
            f"{speed:g} /s: {torque:.4f} N m, exact {formula:.4f} N m, {100 * (torque / formula - 1):+.1f} %"
        )
    inner, outer, height = (given[key] for key in ("inner_radius", "outer_radius", "cylinder_height"))
    whole = 2 * math.pi * outer**2 * height * given["yield_stress"]
    slope, start = np.polyfit(2 * math.pi * turns, found, 1)
    # M = 4π h [μ Ω + τ0 ln(R_o/R_i)]/(R_i⁻² - R_o⁻²), right where all fluid is sheared
    scale = (inner**-2 - outer**-2) / (4 * math.pi * height)
    print(f"straight line: {slope * scale:.3g} Pa s, {start * scale / math.log(outer / inner):.3g} Pa")

    sheet, (plot,) = panels(1, "")
    speeds = np.linspace(1e-6, WIDEST, 200)
    plot.plot(speeds, exact(given, speeds), color=BLUE, lw=1.2, label="Reiner & Riwlin")
    plot.plot(turns, found, "o", color=RED, ms=4, label="runs")
    plot.plot(
        speeds, start + slope * 2 * math.pi * speeds, color=ORANGE, lw=0.9, ls="--", label="straight line"
    )
    plot.axhline(whole, color="grey", lw=0.8, ls=":")
    plot.text(0.03, whole, "all fluid is sheared above", fontsize=7, va="bottom", color="grey")
    plot.set(xlim=(0, WIDEST), ylim=(0, None))
    say(plot, "Coaxial cylinders, 100 Pa and 20 Pa s", "rotation rate / (1/s)", "torque / (N m)")
    plot.legend(frameon=False, fontsize=7, loc="lower right")
    save(sheet, "torque")


def exact(given: dict[str, float], turns: np.ndarray) -> np.ndarray:
    value = FORMULAS[CASE][0].value
    return np.array([value(given | {"turns_per_second": speed}) for speed in turns])


def steady(torque) -> float:
    """Mean of the last twentieth of a run; the torque oscillates with sound waves."""
    values = torque.dropna("time").values
    return float(values[-max(1, len(values) // 20) :].mean())


if __name__ == "__main__":
    main()
