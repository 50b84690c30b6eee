"""Draw docs/images/comparisons/flow_curve.png: three concretes with the same straight line through their flow
curves, in the L-box and in the V-funnel.

    for name in l_box v_funnel; do mpmkit study cases/studies/flow_curve_$name.json; done
    python docs/figures/comparisons/flow_curve.py

The studies take about three minutes of one core, the figure a second; with --draw it needs no runs.
"""

import numpy as np
from shared import BLUE, GREEN, RED, data, panels, save, say

FLUIDS = {"n = 0.7": BLUE, "Bingham": "k", "n = 1.3": RED}
CURVES = {"n = 0.7": (14.307, 45.714, 0.7), "Bingham": (50, 20, 1.0), "n = 1.3": (68.779, 9.414, 1.3)}
"""Yield stress, Pa, consistency, Pa sⁿ, and n; a straight line through each curve from 1 to 10 /s is that of
the Bingham fluid."""
RATES = np.linspace(1, 10, 10)


def main() -> None:
    box, funnel = data(
        flow_curve_l_box=["h1", "h2", "passing_ratio", "at_rest_since"],
        flow_curve_v_funnel=["flow_time", "mass_out", "total_mass"],
    )
    sheet, (curve, ratio, out) = panels(3, "Three concretes with the same straight line, 50 Pa and 20 Pa s")
    rates = np.linspace(0, 12, 200)
    for fluid, color in FLUIDS.items():
        start, consistency, index = CURVES[fluid]
        slope, intercept = np.polyfit(RATES, start + consistency * RATES**index, 1)
        curve.plot(rates, start + consistency * rates**index, color=color, lw=1.2, label=fluid)

        h = box.sel(member=fluid)
        last = {name: float(h[name].dropna("time")[-1]) for name in ("h1", "h2", "passing_ratio")}
        ratio.plot(h.time, h.passing_ratio, color=color, lw=1.2, label=fluid)

        flow = funnel.sel(member=fluid).dropna("time")
        part = flow.mass_out.values / (flow.mass_out.values + flow.total_mass.values)
        out.plot(flow.time, 100 * part, color=color, lw=1.2, label=fluid)
        half, most = (float(np.interp(p, part, flow.time.values)) for p in (0.5, 0.7))
        print(
            f"{fluid}: line {intercept:.1f} Pa + {slope:.2f} Pa s; h1 {1e3 * last['h1']:.1f} mm, "
            f"h2 {1e3 * last['h2']:.1f} mm, h2/h1 {last['passing_ratio']:.3f}, at rest since "
            f"{float(h.at_rest_since):.2f} s; V-funnel: 50 % {half:.2f} s, 70 % {most:.2f} s, "
            f"80 % {float(flow.flow_time[-1]):.2f} s"
        )
    curve.axvspan(1, 10, color=GREEN, alpha=0.1, lw=0)
    curve.set(xlim=(0, 12), ylim=(0, None))
    ratio.set(xlim=(0, 12), ylim=(0, None))
    out.set(xlim=(0, None), ylim=(0, 85))
    say(
        curve, "Flow curves; the line is fitted in the green range", "shear rate / (1/s)", "shear stress / Pa"
    )
    say(ratio, "L-box", "time / s", "h2/h1")
    say(out, "V-funnel", "time / s", "mass that is out / %")
    for plot in (curve, ratio, out):
        plot.legend(frameon=False, fontsize=7, loc="lower right")
    save(sheet, "flow_curve")


if __name__ == "__main__":
    main()
