"""A film and a tank that are sheared on and on."""

from accurate_setup import bingham
from channel import Fluid, down_slope

import mpmkit

MORTAR = Fluid(yield_stress=40.0, consistency=20.0, density=2300.0)
ANGLE, THICK, CELLS, SOUND = 30.0, 0.05, 8, 12.0
"""Degrees, m, cells across the film, m/s."""
FILM_UNTIL, TANK_UNTIL = 12.0, 5.0
TANK, BLOCK = (1.5, 0.5), (0.56, 0.28)
"""Length and height, m."""


def film(scheme: dict) -> mpmkit.Simulation:
    """On a stick floor, periodic along the slope."""
    drive, across = down_slope(MORTAR.density, ANGLE)
    cell = THICK / CELLS
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": FILM_UNTIL,
                "gravity": [drive / MORTAR.density, -across],
                "grid": {
                    "cell_size": cell,
                    "domain": {"x": [0, 4 * cell], "z": [0, 2 * THICK]},
                    "faces": {"z_min": "stick", "x_min": "periodic", "x_max": "periodic"},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0, 0], "upper": [4 * cell, THICK]},
                        "material": bingham(40.0, 20.0, density=MORTAR.density, sound_speed=SOUND),
                    }
                ],
                "scheme": scheme,
            }
        )
    )


def tank(scheme: dict) -> mpmkit.Simulation:
    """A block that is released at one end of a closed tank with slip walls."""
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": TANK_UNTIL,
                "grid": {
                    "cell_size": 0.02,
                    "domain": {"x": [0, TANK[0]], "z": [0, TANK[1]]},
                    "faces": dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "slip"),
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0, 0], "upper": BLOCK},
                        "material": bingham(40.0, 20.0, density=2300.0, sound_speed={"factor": 10}),
                    }
                ],
                "scheme": scheme,
            }
        )
    )
