"""Draw docs/images/spaces.png: the quarter model against the body of revolution, both at 10 mm.

    python docs/figures/spaces.py

Takes about three minutes, nearly all of them for the quarter.
"""

import numpy as np
from common import DOCS, figure, plot_reference
from options import parser

import mpmkit

COARSE = ["grid.cell_size=0.01", 'grid.domain={"r": [0, 0.36], "z": [0, 0.31]}']
UNTIL = 1.0
RUNS = (
    ("slump", COARSE, "axisymmetric, 900 particles at first", {"color": "#0072B2"}),
    ("slump_quarter", [], "quarter model, 11,011 particles at first", {"color": "#009E73", "ls": "-."}),
)


def main() -> None:
    parser().parse_args()
    sheet, axes = figure("Slump, free-slip floor, 10 mm, the accurate set-up")
    plot_reference(axes)
    spreads = []
    for name, overrides, label, style in RUNS:
        case = mpmkit.load_case(DOCS.parent / f"cases/{name}.json", [*overrides, f"until={UNTIL}"])
        history = mpmkit.run(case, listen=lambda p: print(f"t = {p.time:.3f} s, {p.seconds_left:.0f} s left"))
        axes.plot(history.time, 1e3 * history.spread_diameter, label=label, **style)
        spreads.append(np.interp(np.linspace(0, UNTIL, 101), history.time, history.spread_diameter))
        print(f"{name}: T500 {history.attrs['t500']:.3f} s")
    apart = np.abs(spreads[1] / spreads[0] - 1)
    print(f"apart by at most {apart.max():.2%}, at the end by {apart[-1]:.2%}")
    for spread in spreads:
        print("spread at 0.1, 0.2 … 1 s:", np.round(spread[10::10], 4))
    axes.legend(frameon=False)
    sheet.savefig(DOCS / "images" / "spaces.png")


if __name__ == "__main__":
    main()
