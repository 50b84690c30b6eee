"""A rough bar that is drawn slowly through a plastic material, with one and a half cells in its diameter."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import close_to

import mpmkit
from mpmkit.rheology.deposits import BAR

pytestmark = pytest.mark.section(8)
DIAMETER, YIELD_STRESS, SPEED = 0.018, 100.0, 0.02
CELL = DIAMETER / 1.5
HALF = 9 * CELL
"""Half of the width of the box, six diameters."""


def arc(middle, first, last):
    angles = np.linspace(first, last, 17)
    circle = middle + DIAMETER / 2 * np.column_stack([np.cos(angles), np.sin(angles)])
    return circle.tolist()


def scene(middle):
    """A box full of material, in two pieces around the bar."""
    z = middle[1]
    upper = [[-HALF, z], *arc(middle, math.pi, 0), [HALF, z], [HALF, HALF], [-HALF, HALF]]
    lower = [[HALF, z], *arc(middle, 0, -math.pi), [-HALF, z], [-HALF, -HALF], [HALF, -HALF]]
    paste = {
        "law": "bingham-evp",
        "density": 2300,
        "yield_stress": YIELD_STRESS,
        "plastic_viscosity": 0.1,
        "sound_speed": 4,
    }
    disc = {"kind": "polygon", "corners": arc(middle, 0, 2 * math.pi)[:-1]}
    drawn = {"kind": "velocity", "velocity": [SPEED, 0]}
    return {
        "space": "plane-strain",
        "until": 0.2,
        "gravity": [0, 0],
        "grid": {
            "cell_size": CELL,
            "domain": {"x": [-HALF, HALF], "z": [-HALF, HALF]},
            "faces": dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "stick"),
        },
        "walls": {
            "bar": {
                "surface": {"kind": "body", "shape": disc, "side": "outside", "motion": drawn},
                "contact": "stick",
            }
        },
        "bodies": [
            {"shape": {"kind": "polygon", "corners": corners}, "material": paste}
            for corners in (upper, lower)
        ],
        "scheme": {"redistribution": "none"},
        "output": {"report": False, "history_interval": 0.01},
        "measurements": {"drag": {"formula": "force('bar', 'x')", "unit": "N/m", "description": "its force"}},
    }


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.5, 0.5), (0.25, 0.4)])
def test_a_bar_takes_the_force_of_randolph_and_houlsby(validate, place):
    """(4√2 + 2π) τ0 d, wherever the bar is between the nodes, here in cells.

    The band of 30 % was set after runs in a paste ten times as viscous: 20 to 28 % too large with 1.5 cells
    in the diameter, and 13 to 19 % with 4.
    """
    history = mpmkit.run(mpmkit.parse_case(scene(CELL * np.array(place))), threads=1)
    drag = history["drag"].values[-10:].mean() / (YIELD_STRESS * DIAMETER)
    validate(f"Bar drawn through a paste, at {place} cells: force over τ0 d", drag, close_to(BAR, rel=0.3))
