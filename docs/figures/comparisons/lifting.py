"""Draw docs/images/comparisons/lifting.png: the spread of a slump test over time, by how the mould is lifted.

    mpmkit study cases/studies/lifting.json
    python docs/figures/comparisons/lifting.py

The study takes about five minutes of one core, the figure a second; with --draw it needs no runs.
"""

from shared import BLUE, GREEN, ORANGE, RED, data, panels, save, say

LIFTS = {"at once": "k", "300 mm/s": BLUE, "150 mm/s": GREEN, "100 mm/s": RED}
FLOORS = {"slip": "Slip floor", "stick": "Stick floor"}


def main() -> None:
    (runs,) = data(lifting=["spread_diameter", "t500", "final_spread"])
    sheet, plots = panels(2, "Concrete of the slump test, for several lifting speeds")
    for plot, (floor, title) in zip(plots, FLOORS.items(), strict=True):
        for lift, color in LIFTS.items():
            spread = runs.spread_diameter.sel(floor=floor, lift=lift).dropna("time")
            plot.plot(spread.time, 1e3 * spread, color=color, lw=1.2, label=lift)
        plot.axhline(500, color=ORANGE, lw=0.8, ls=":")
        plot.set(xlim=(0, 2), ylim=(190, 640))
        say(plot, title, "time from the start of the lift / s", "spread diameter / mm")
        plot.legend(frameon=False, fontsize=7, loc="lower right")
    save(sheet, "lifting")


if __name__ == "__main__":
    main()
