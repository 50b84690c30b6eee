"""A stiff block that friction must hold on an incline: on a face of the grid, and on a plane between nodes.

The block is released without stress, so that its normal force on the wall oscillates between zero and twice
its weight. While the force is less than tan θ/μ of the weight, the block slides. When the oscillation has
died down, the block stays.
"""

from __future__ import annotations

import math

import pytest
from bands import below
from clock import advance_to
from test_block_on_wall import CELL, INCLINE, block
from wall_scenes import STIFF, G, centre, coulomb, grid

import mpmkit

pytestmark = pytest.mark.section(6)
SLIDES = G * (math.sin(math.radians(INCLINE)) - 0.2 * math.cos(math.radians(INCLINE)))
"""Acceleration with the coefficient 0.2, m/s²: what stays is measured by it, and by its band, a hundredth."""


def on_face(coefficient):
    tilt, length = math.radians(INCLINE), 10 * CELL
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 2.0,
                "gravity": [-G * math.sin(tilt), -G * math.cos(tilt)],
                "grid": {
                    **grid(CELL, [-0.2, 0.0], [1.2, 0.6]),
                    "faces": {"z_min": {"kind": "friction", "coefficient": coefficient}},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0.6, 0.0], "upper": [0.6 + length, 6 * CELL]},
                        "material": STIFF,
                    }
                ],
            }
        )
    )


def on_plane(coefficient):
    return block(0.0, (0.3, 0.37), coulomb(coefficient))[0]


def hold(validate, wall, coefficient, since, until):
    """Distance that the block slides, over that of a block with the friction coefficient 0.2."""
    simulation = {"face": on_face, "plane": on_plane}[wall](coefficient)
    advance_to(simulation, since)
    before = centre(simulation)[0]
    advance_to(simulation, until)
    went = before - centre(simulation)[0]
    name = f"Block on an incline of 20°, {wall}, friction {coefficient:g}, {since:g} to {until:g} s"
    part = abs(went) / (SLIDES * (until**2 - since**2) / 2)
    validate(f"{name}: way over that with friction 0.2", part, below(0.01, "0"))


@pytest.mark.parametrize(("wall", "coefficient"), [("face", 1.0), ("plane", 0.6)])
def test_block_is_held_soon(validate, wall, coefficient):
    hold(validate, wall, coefficient, 0.1, 0.3)


CREEPS = pytest.mark.xfail(
    reason="2 % of the way: it creeps at 57 mm/s at 0.2 s, 32 at 0.5 s and 20 at 1 s, and does not stop;"
    " on a face it stops after 0.6 s",
    strict=True,
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wall", "coefficient"),
    [
        ("face", 0.4), ("face", 0.6), ("face", 1.0),
        pytest.param("plane", 0.4, marks=CREEPS), ("plane", 0.6), ("plane", 1.0),
    ],
)  # fmt: skip
def test_block_stays(validate, wall, coefficient):
    hold(validate, wall, coefficient, 0.5, 1.0)
