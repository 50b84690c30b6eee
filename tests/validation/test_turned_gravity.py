"""A block on a floor that tilts: by forces in the frame of the floor, and by a moving wall."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest
from bands import close_to
from clock import advance_to

from mpmkit.case import parse_case
from mpmkit.solver.simulation import Simulation

pytestmark = [pytest.mark.section(7), pytest.mark.slow]

RATE, LATE, HALF = -0.1, 1.2, 0.05
"""rad/s of the floor; s, the end; m, half the side of the block."""
FLOOR = {
    "kind": "body",
    "shape": {"kind": "box", "lower": [-0.2, -0.1], "upper": [0.6, 0]},
    "side": "outside",
}
STIFF = {"law": "neo-hookean", "density": 1000, "youngs_modulus": 5e4, "poisson_ratio": 0.3}
BLOCK = {
    "shape": {"kind": "box", "lower": [-HALF, 0.0], "upper": [HALF, 2 * HALF]},
    "material": STIFF,
}
SCENE = {
    "space": "plane-strain",
    "until": LATE,
    "grid": {"cell_size": 0.0125, "domain": {"x": [-0.1, 0.5], "z": [-0.15, 0.2]}},
    "bodies": [BLOCK],
    "walls": {"floor": {"surface": FLOOR, "contact": "slip"}},
}
TURNS = {"floor": {"surface": FLOOR | {"motion": {"kind": "rotation", "point": [0, 0], "rate": RATE}},
                   "contact": "slip"}}  # fmt: skip
AS_THE_FLOOR_SEES_IT = {
    "tilt": {"kind": "turning-gravity", "vector": [0, -9.81], "rate": -RATE},
    "frame": {"kind": "rotating-frame", "point": [0, 0], "rate": RATE},
}


def slid(changes: dict, angle: float) -> tuple[float, float, float]:
    """Position along the floor, m, speed along it, m/s, and height, m, of the centre of mass at the end."""
    simulation = Simulation(parse_case(copy.deepcopy(SCENE) | changes))
    advance_to(simulation, LATE)
    p, along = simulation.particles, np.array([math.cos(angle), math.sin(angle)])
    place, velocity = p.mass @ np.stack([p.position + simulation.grid.lower, p.velocity]) / p.mass.sum()
    return place @ along, velocity @ along, place @ [-along[1], along[0]]


def test_gravity_that_turns_is_a_floor_that_turns(validate):
    """At the start the block is at rest in the laboratory, and moves by -ω × r relative to the floor."""
    starts = {"bodies": [BLOCK | {"velocity": [HALF * RATE, 0]}]}
    seen, speed, _ = slid(starts | {"forces": AS_THE_FLOOR_SEES_IT}, 0.0)
    place, of_laboratory, height = slid({"walls": TURNS}, RATE * LATE)
    turned = of_laboratory + RATE * height  # relative to the floor
    exact = 9.81 * abs(RATE) * LATE**2 / 2 + HALF * RATE  # sin α ≈ α to 0.2 %
    name = "Block on a floor that tilts at 0.1 rad/s, 8 cells wide, after 1.2 s"
    validate(
        f"{name}: speed with gravity that turns over that on rigid ground",
        speed / exact,
        close_to(1, rel=0.01),
    )
    validate(
        f"{name}: speed with the floor that turns over that with gravity",
        turned / speed,
        close_to(1, rel=0.01),
    )
    validate(
        f"{name}: way with the floor that turns over that with gravity", place / seen, close_to(1, rel=0.01)
    )
