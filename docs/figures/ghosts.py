"""Draw docs/images/ghosts.png: the slump on a mirror, and on a floor that holds its ghost nodes at zero.

    python docs/figures/ghosts.py

Takes about a minute. The second floor is no choice of mpmkit; it is put in here from outside.
"""

import csv
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import mpmkit

DOCS = Path(__file__).parents[1]
REFERENCE = DOCS.parent / "tests/validation/reference/slump_free_slip_herschel_bulkley.csv"
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


def hold_floor(simulation: mpmkit.Simulation) -> None:
    """Set the vertical velocity of the nodes on the floor and behind it to zero, whenever it is computed."""
    operations, window = simulation.operations, simulation.operations.window

    def held(original):
        def operation(*args, **kwargs):
            original(*args, **kwargs)
            floor = window.walls[1, 0]
            nodes = window.nodes.reshape(*window.shape[:2], -1)
            nodes[:, max(floor - 1, 0) : floor + 1, [2, 4]] = 0.0

        return operation

    operations.map_to_grid = held(operations.map_to_grid)
    operations.solve_momentum = held(operations.solve_momentum)


def main() -> None:
    path = DOCS.parent / "cases/slump.json"
    mirror = mpmkit.Simulation(mpmkit.load_case(path, COARSE))
    zero = mpmkit.Simulation(mpmkit.load_case(path, [*COARSE, "grid.faces.z_min=open"]))
    hold_floor(zero)
    with REFERENCE.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))

    figure = Figure(figsize=(6.4, 4), dpi=160, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    reference = [[float(row[name]) for row in rows] for name in ("time_s", "spread_diameter_m")]
    axes.plot(reference[0], np.multiply(reference[1], 1e3), "k--", label="incompressible finite elements")
    axes.plot(TIMES, np.multiply(spread(mirror), 1e3), color="#0072B2", label="ghosts mirror the floor")
    axes.plot(TIMES, np.multiply(spread(zero), 1e3), color="#D55E00", label="ghosts held at zero")
    axes.set(xlim=(0, 1), ylim=(180, 580), xlabel="time / s", ylabel="spread diameter / mm")
    axes.set_title("Slump, free-slip floor, axisymmetric, 10 mm, the seed's scheme", fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    figure.savefig(DOCS / "images" / "ghosts.png")


if __name__ == "__main__":
    main()
