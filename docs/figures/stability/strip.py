"""A strip between a wall and a heavy block that flies off: its exact motion is an even stretch, however fast.

In units of a cell, of the density at first and of the speed of its waves. The material is neo-Hookean with
nu = 0, of which the traction is E (lambda - 1/lambda)/2. What each cell of the grid carries of that is
measured on the nodes: the sum of the internal forces on those beyond it.
"""

import itertools

import numpy as np

import mpmkit

CELLS, BLOCK, HEAVY = 16, 2, 1e6
BEYOND = 2
"""Cells of the strip, as it was, beside the block that are not looked at."""
TORN = 0.02
"""Part of the traction below which a cell carries none."""


def strip(count: int, scheme: dict, speed: float, longest: float) -> mpmkit.Simulation:
    """``count`` particles a cell; the block flies at ``speed``, so that the stretch grows by speed/CELLS."""
    bodies = [
        {
            "shape": {"kind": "box", "lower": [lower, 0.0], "upper": [upper, 1.0]},
            "material": {
                "law": "neo-hookean",
                "density": density,
                "youngs_modulus": 1.0,
                "poisson_ratio": 0.0,
            },
            "particles_per_cell": [count, 1],
        }
        for lower, upper, density in ((0, CELLS, 1.0), (CELLS, CELLS + BLOCK, HEAVY))
    ]
    case = mpmkit.parse_case(
        {
            "space": "plane-strain",
            "until": 1e6,
            "gravity": [0.0, 0.0],
            "grid": {
                "cell_size": 1.0,
                "domain": {"x": [0, int(CELLS * longest) + 6], "z": [0, 1]},
                "faces": {"x_min": "symmetry", "z_min": "symmetry", "z_max": "symmetry"},
            },
            "bodies": bodies,
            "scheme": {"order": "usf", "velocity": "flip", "redistribution": "none", **scheme},
        }
    )
    # Waves over a cell are faster in a strip that is drawn out, √((lambda² + 1)/2); a step that is short
    # beside the rate as well leaves the motion exact.
    fraction = min(0.3 / longest, 0.005 * CELLS / speed)
    simulation = mpmkit.Simulation(case, fraction=fraction)
    p = simulation.particles
    p.velocity[:, 0] = speed / CELLS * np.minimum(p.position[:, 0], CELLS)
    return simulation


def carried(simulation: mpmkit.Simulation, stretch: float) -> np.ndarray:
    """Traction of every cell over the exact one."""
    operations = simulation.operations
    operations.begin()
    operations.map_to_grid()
    window, dim = operations.window, simulation.grid.dim
    force = window.nodes.reshape(*window.shape[:dim], -1)[..., 1 + dim].sum(axis=1)
    beyond = -np.cumsum(force[::-1])[::-1]
    cells = beyond[1 - window.lower[0] :][: int((CELLS - BEYOND) * stretch)]
    return cells / (0.5 * (stretch - 1 / stretch))


def largest_stretch(count: int, scheme: dict, speed: float, longest: float) -> float:
    """The stretch at which a cell first carries nothing; infinite if none does up to ``longest``."""
    simulation = strip(count, scheme, speed, longest)
    for step in itertools.count(1):
        simulation.advance()
        stretch = 1 + speed / CELLS * simulation.time
        if stretch > longest:
            return np.inf
        if step % 4 == 0 and stretch > 1.02 and carried(simulation, stretch).min() < TORN:
            return stretch
    raise AssertionError
