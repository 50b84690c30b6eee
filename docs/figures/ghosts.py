"""Draw docs/images/ghosts.png: the slump on a mirror, and on a floor that holds its ghost nodes at zero.

    python docs/figures/ghosts.py

Takes about a minute. The second floor is no choice of mpmkit; it is put in here from outside.
"""

import numba
import numpy as np
from common import DOCS, figure, plot_reference
from floors import hold_floor
from options import parser

import mpmkit

COARSE = ["grid.cell_size=0.01", 'grid.domain={"r": [0, 0.36], "z": [0, 0.31]}']
TIMES = np.linspace(0, 1, 51)


def spread(simulation: mpmkit.Simulation) -> list[float]:
    found = []
    for time in TIMES:
        while simulation.time < time * (1 - 1e-12):
            simulation.advance(time - simulation.time)
        found.append(simulation.measures(simulation.particles)["spread_diameter"])
        print(f"t = {time:.2f} s  D = {found[-1]:.4f} m")
    return found


def main() -> None:
    parser().parse_args()
    numba.set_num_threads(1)  # 900 particles are too few for more
    path = DOCS.parent / "cases/slump_as_published.json"
    mirror = mpmkit.Simulation(mpmkit.load_case(path, COARSE))
    zero = mpmkit.Simulation(mpmkit.load_case(path, [*COARSE, "grid.faces.z_min=open"]))
    hold_floor(zero)

    sheet, axes = figure("Slump, free-slip floor, axisymmetric, 10 mm, the paper's scheme")
    plot_reference(axes)
    axes.plot(TIMES, np.multiply(spread(mirror), 1e3), color="#0072B2", label="ghosts mirror the floor")
    axes.plot(TIMES, np.multiply(spread(zero), 1e3), color="#D55E00", label="ghosts held at zero")
    axes.legend(frameon=False)
    sheet.savefig(DOCS / "images" / "ghosts.png")


if __name__ == "__main__":
    main()
