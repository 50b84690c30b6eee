"""Draw docs/images/comparisons/orders_lifted.png: USL, USF and MUSL as the mould of a slump test is lifted.

    mpmkit study cases/studies/orders_lifted.json
    python docs/figures/comparisons/orders_lifted.py

The study takes about a minute and a half of one core, the figure a second; with --draw it needs no runs.
"""

import numpy as np
from shared import DOCS, ORDERS, data, panels, save, say

REFERENCE = DOCS.parent / "tests/validation/reference/slump_lifted_free_slip_herschel_bulkley.csv"


def main() -> None:
    (runs,) = data(orders_lifted=["spread_diameter", "t500", "final_spread", "lift"])
    time, spread = reference()
    late = (time >= 0.1) & (time <= 2)
    for cells in ("20 mm", "10 mm"):
        for step in ("0.4", "0.1"):
            for order in ORDERS:
                run = runs.sel(cells=cells, step=step, order=order)
                found = np.interp(time, runs.time, run.spread_diameter)
                error = np.abs(found / spread - 1)[late].max()
                impulse = float(np.trapezoid(run.lift.fillna(0), runs.time))
                print(
                    f"{cells}, step {step}, {order}: T500 {float(run.t500):.4f} s, spread "
                    f"{1e3 * float(run.final_spread):.2f} mm, largest error {100 * error:.1f} %, "
                    f"impulse on the mould {impulse:.3f} N s"
                )
    sheet, (whole, apart, force) = panels(3, "The slump test, its mould lifted at 300 mm/s")
    whole.plot(time, 1e3 * spread, "k", lw=1.0, label="finite elements")
    for order, style in ORDERS.items():
        run = runs.sel(cells="10 mm", step="0.4", order=order)
        whole.plot(runs.time, 1e3 * run.spread_diameter, lw=1.2, label=f"{order}, 10 mm", **style)
        force.plot(runs.time, run.lift, lw=1.0, label=order, **style)
    for step, width in (("0.4", 1.8), ("0.1", 0.8)):
        of = runs.spread_diameter.sel(cells="10 mm", step=step)
        for order in ("USF", "MUSL"):
            less = 1e3 * (of.sel(order=order) - of.sel(order="USL"))
            apart.plot(runs.time, less, lw=width, label=f"{order}, step {step}", **ORDERS[order])
    whole.set(xlim=(0, 2), ylim=(190, 620))
    apart.set_ylim(-0.15, 0.15)
    force.set(xlim=(0, 0.5))
    say(whole, "Spread", "time / s", "spread diameter / mm")
    say(apart, "10 mm", "time / s", "spread less that of USL / mm")
    say(force, "10 mm, step 0.4", "time / s", "upward force on the mould / N")
    for plot, where in ((whole, "lower right"), (apart, "upper right"), (force, "upper right")):
        plot.legend(frameon=False, fontsize=7, loc=where)
    save(sheet, "orders_lifted")


def reference() -> tuple[np.ndarray, np.ndarray]:
    """Time, s, and spread, m, of the incompressible finite-element solution of the lifted mould."""
    lines = [line for line in REFERENCE.read_text().splitlines() if not line.startswith("#")]
    table = np.loadtxt(lines[1:], delimiter=",")
    return table[:, 0], table[:, 1]


if __name__ == "__main__":
    main()
