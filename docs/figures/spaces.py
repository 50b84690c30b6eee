"""Draw docs/images/spaces.png: the quarter model against the body of revolution, both at 10 mm.

    python docs/figures/spaces.py

Takes some minutes, nearly all of them for the quarter.
"""

from common import DOCS, figure, plot_reference

import mpmkit

COARSE = ["grid.cell_size=0.01", 'grid.domain={"r": [0, 0.36], "z": [0, 0.31]}']


def main() -> None:
    sheet, axes = figure("Slump, free-slip floor, 10 mm, the paper's scheme")
    plot_reference(axes)
    for name, overrides, label, style in (
        ("slump", COARSE, "axisymmetric, 900 particles", {"color": "#0072B2"}),
        ("slump_quarter", [], "quarter model, 11,011 particles", {"color": "#009E73", "linestyle": "-."}),
    ):
        case = mpmkit.load_case(DOCS.parent / f"cases/{name}.json", [*overrides, "until=1"])
        history = mpmkit.run(case, listen=lambda p: print(f"t = {p.time:.3f} s, {p.seconds_left:.0f} s left"))
        axes.plot(history.time, 1e3 * history.spread_diameter, label=label, **style)
    axes.legend(frameon=False)
    sheet.savefig(DOCS / "images" / "spaces.png")


if __name__ == "__main__":
    main()
