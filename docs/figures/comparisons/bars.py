"""Draw docs/images/comparisons/bars.png: the J-ring with 16 bars, with 12, and without.

    mpmkit study cases/studies/bars.json
    python docs/figures/comparisons/bars.py

The study takes about five minutes of one core, the figure a second; with --draw it needs no runs.
"""

from shared import BLUE, ORANGE, RED, data, panels, save, say

from mpmkit.case.load import read_json
from mpmkit.case.parameters import parameters
from mpmkit.case.shipped import shipped_case
from mpmkit.rheology.laboratory import FORMULAS

RINGS = {"none": "k", "12 bars": BLUE, "16 bars": RED}
GIVEN = {"none": {"bar_diameter": 0.0}, "12 bars": {"bars_in_quarter": 3}, "16 bars": {}}
"""Parameters of the closed form, beside those of the case."""


def main() -> None:
    (runs,) = data(bars=["j_ring_flow", "height_inside", "height_outside", "t500_from_lift"])
    given = {key: entry.value for key, entry in parameters(read_json(shipped_case("j_ring"))).items()}
    flow, step, _ = (formula.value for formula in FORMULAS["j_ring"])
    for ring in RINGS:
        found, said = runs.sel(ring=ring).dropna("time").isel(time=-1), given | GIVEN[ring]
        inside, outside = 1e3 * float(found.height_inside), 1e3 * float(found.height_outside)
        print(
            f"{ring}: flow {1e3 * float(found.j_ring_flow):.0f} mm, closed form {1e3 * flow(said):.0f} mm; "
            f"inside {inside:.1f} mm, outside {outside:.1f} mm, step {inside - outside:.1f} mm, "
            f"closed form {1e3 * step(said):.1f} mm; t500 {float(found.t500_from_lift):.2f} s"
        )

    sheet, (spread, height) = panels(2, "The J-ring: 50 Pa, 30 Pa s, no aggregate")
    for ring, color in RINGS.items():
        of = runs.sel(ring=ring)
        spread.plot(of.time, 1e3 * of.j_ring_flow, color=color, lw=1.2, label=ring)
        height.plot(of.time, 1e3 * of.height_inside, color=color, lw=1.2, label=f"{ring}, middle")
        height.plot(of.time, 1e3 * of.height_outside, color=color, lw=1.2, ls="--")
    spread.axhline(500, color=ORANGE, lw=0.8, ls=":")
    spread.set(xlim=(0, 10), ylim=(190, 600))
    height.set(xlim=(0, 10), ylim=(0, 120))
    say(spread, "Spread", "time from the start of the lift / s", "spread / mm")
    say(height, "Height in the middle; dashed: outside", "time / s", "height / mm")
    spread.legend(frameon=False, fontsize=7, loc="lower right")
    height.legend(frameon=False, fontsize=7, loc="upper right")
    save(sheet, "bars")


if __name__ == "__main__":
    main()
