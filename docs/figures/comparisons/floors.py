"""Draw docs/images/comparisons/floors.png: the spread of a slump test over time, by what its floor allows.

    mpmkit study cases/studies/floors.json
    python docs/figures/comparisons/floors.py

The study takes about one minute of one core, the figure a second; with --draw it needs no runs.
"""

from shared import BLUE, GREEN, ORANGE, RED, data, panels, save, say

FLOORS = {"stick": "k", "1 mm": BLUE, "10 mm": GREEN, "100 mm": ORANGE, "slip": RED}


def main() -> None:
    (runs,) = data(floors=["spread_diameter", "t500", "final_spread", "final_slump"])
    sheet, (plot,) = panels(1, "")
    for floor, color in FLOORS.items():
        spread = runs.spread_diameter.sel(floor=floor).dropna("time")
        label = floor if floor in ("stick", "slip") else f"slip length {floor}"
        plot.plot(spread.time, 1e3 * spread, color=color, lw=1.2, label=label)
    plot.axhline(500, color="grey", lw=0.8, ls=":")
    plot.set(xlim=(0, 2.5), ylim=(190, 640))
    say(plot, "Concrete of the slump test on five floors", "time / s", "spread diameter / mm")
    plot.legend(frameon=False, fontsize=7, loc="lower right")
    save(sheet, "floors")


if __name__ == "__main__":
    main()
