"""A viscoplastic dam break comes to rest where lubrication theory says.

At rest on a stick floor the pressure gradient is held by the yield stress, rho g h dh/dx = -tau0, so that

    h² = 2 tau0 (L - x)/(rho g),   L = (9 A² rho g / (8 tau0))^(1/3)

for an area A on one side of the plane of symmetry. The concrete of the slump test, A = 0.03 m²: L = 0.513 m
and h(0) = 87.6 mm, to the square of the slope, some per cent.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from accurate_setup import herschel_bulkley, scheme
from bands import below, close_to
from clock import at

import mpmkit

pytestmark = pytest.mark.section(4)

YIELD_STRESS, DENSITY, G, AREA = 188.91, 2574.0, 9.81, 0.03
LENGTH = (9 * AREA**2 * DENSITY * G / (8 * YIELD_STRESS)) ** (1 / 3)
TOP = math.sqrt(2 * YIELD_STRESS * LENGTH / (DENSITY * G))


def column(width: float, cell_size: float) -> mpmkit.Simulation:
    height = AREA / width
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 10.0,
                "grid": {
                    "cell_size": cell_size,
                    "domain": {"x": [0.0, 0.8], "z": [0.0, height + 2 * cell_size]},
                    "faces": {"z_min": "stick", "x_min": "symmetry"},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [width, height]},
                        "material": herschel_bulkley(
                            YIELD_STRESS, 45.65, 1.33, density=DENSITY, sound_speed={"factor": 6}
                        ),
                    }
                ],
                "scheme": scheme(),
            }
        )
    )


@pytest.mark.slow
def test_dam_break_at_rest(validate):
    """A column 0.15 m wide and 0.2 m high is let go at once, and stops after 5 s."""
    simulation = column(0.15, 0.01)
    times = np.linspace(0, 7, 29)
    p, length = simulation.particles, []
    for _ in at(simulation, times):
        length.append(float((p.position[:, 0] + p.box[:, 0]).max()))
    found = simulation.measures(p)
    name = "Plane dam break of concrete at rest"
    validate(f"{name}: length L", length[-1], close_to(LENGTH, rel=0.1), unit="m")
    validate(f"{name}: height h(0)", found["axis_height"], close_to(TOP, rel=0.1), unit="m")
    validate(f"{name}: growth of L in the last second, of L", 1 - length[-5] / length[-1], below(1e-2, "0"))
    exact = np.linspace(0, LENGTH, 400)
    chart = validate.figure("plastic_dam_break", name, x="x (m)", y="height (m)")
    chart.reference("lubrication", exact, np.sqrt(2 * YIELD_STRESS * (LENGTH - exact) / (DENSITY * G)))
    chart.points("particles, cells of 10 mm", p.position[:, 0], p.position[:, 1])
    title = "Plane dam break of concrete: length"
    chart = validate.figure("plastic_dam_break_length", title, x="time (s)", y="length (m)")
    chart.reference("lubrication, at rest", [0, 7], [LENGTH, LENGTH])
    chart.line("mpmkit, 10 mm", times, length)
