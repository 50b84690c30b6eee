"""Scenes of a block and walls."""

from __future__ import annotations

import copy

import mpmkit
from mpmkit.solver.simulation import Simulation

CELL = 0.05
FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 5.0, "sound_speed": 15.0}


def wall(point, normal, contact="slip", **more):
    return {"surface": {"kind": "plane", "point": point, "normal": normal, **more}, "contact": contact}


def scene(walls, material=FLUID, velocity=(0.0, 0.0), lower=(0.2, 0.2), upper=(0.5, 0.4), faces=None, **more):
    """A block in plane strain."""
    case = {
        "space": "plane-strain",
        "until": 1.0,
        "grid": {
            "cell_size": CELL,
            "domain": {"x": [-0.5, 1.0], "z": [-0.5, 1.0]},
            "faces": faces or {},
        },
        "walls": walls,
        "bodies": [
            {
                "shape": {"kind": "box", "lower": list(lower), "upper": list(upper)},
                "material": material,
                "velocity": list(velocity),
            }
        ],
    }
    return copy.deepcopy(case | more)


def simulated(*arguments, **more):
    return Simulation(mpmkit.parse_case(scene(*arguments, **more)))


def advance(simulation, steps):
    for _ in range(steps):
        simulation.advance()
    return simulation


UP = {"kind": "velocity", "velocity": [0.1, 0.4]}
SLOPE = wall([0.2, 0.16], [-0.1, 1.0], {"kind": "coulomb", "coefficient": 0.3}, motion=UP)
