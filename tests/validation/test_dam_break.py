"""A dam break of water: Martin & Moyce, Phil. Trans. R. Soc. A 244 (1952) 312-324, n² = 2.

A column a = 57.15 mm wide and 2 a high stands between a wall and a dam that is drawn away. Its front reaches
x = Z a at t = T √(a/2g). The time of the experiment starts when the dam has moved, not when the water has. So
one time offset of at most 0.3 of T is allowed, and stated.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from accurate_setup import PAPER, scheme
from bands import between
from clock import at

import mpmkit

pytestmark = pytest.mark.section(4)

WIDTH, G = 0.05715, 9.81
UNIT = math.sqrt(WIDTH / (2 * G))
MEASURED = {0.84: 1.22, 1.19: 1.44, 1.63: 1.89, 1.98: 2.33, 2.32: 2.78, 2.65: 3.22, 2.98: 3.67, 3.33: 4.11}


def column(cells, **scheme):
    dx = WIDTH / cells
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 1.0,
                "grid": {
                    "cell_size": dx,
                    "domain": {"x": [0.0, 6 * WIDTH], "z": [0.0, 3 * WIDTH]},
                    "faces": {"x_min": "slip", "z_min": "slip"},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [WIDTH, 2 * WIDTH]},
                        "material": {
                            "law": "newtonian",
                            "density": 1000.0,
                            "viscosity": 1e-3,
                            "sound_speed": {"factor": 10},
                        },
                    }
                ],
                "scheme": scheme,
            }
        )
    )


@pytest.mark.parametrize("numerics", [pytest.param(PAPER, id="paper"), pytest.param(scheme(), id="accurate")])
def test_front_of_the_surge(validate, request, numerics):
    simulation, label = column(16, **numerics), request.node.callspec.id
    times = np.linspace(0, 3.7, 75)
    p, front = simulation.particles, []
    for _ in at(simulation, times * UNIT):
        front.append(float((p.position[:, 0] + p.box[:, 0]).max()) / WIDTH)
    T, Z = np.array(list(MEASURED)), np.array(list(MEASURED.values()))
    offsets = np.linspace(-0.3, 0.3, 61)
    worst = [np.abs(np.interp(T + offset, times, front) / Z - 1).max() for offset in offsets]
    offset = float(offsets[np.argmin(worst)])
    name = f"Martin & Moyce, n² = 2, {label} set-up"
    validate(f"{name}: time offset", offset, between(-0.3, 0.3, "at most 0.3"))
    for t, z in MEASURED.items():
        found = float(np.interp(t + offset, times, front))
        validate(f"{name}: front at T = {t:g}", found, between(0.9 * z, 1.1 * z, f"{z:g}"))
    title = "Front of a water column that is let go"
    chart = validate.figure(
        "martin_moyce",
        title,
        x="T = t √(2g/a)",
        y="Z = x/a",
        caption="Times of the simulation are less its offset.",
    )
    chart.measured("Martin & Moyce 1952", T, Z)
    chart.line(f"mpmkit, {label} set-up, 16 cells wide", times - offset, front)
