"""A standing wave in a tank: omega² = g k tanh(k H).

A tank of length L with slip walls, filled to H. Its first mode, k = pi / L, started from a level surface:

    u = a omega sin(kx) cosh(kz)/sinh(kH),   w = -a omega cos(kx) sinh(kz)/sinh(kH),

with an amplitude a of 2 % of H, so that the wave is linear to a² k² = 0.1 %. Its viscosity is that of water,
too little to count. The pressure starts hydrostatic, so that nothing rings. The wave is measured by what the
particles' velocity has in common with that of the mode.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import close_to

import mpmkit

pytestmark = pytest.mark.section(4)

LENGTH, DEPTH, DENSITY, G = 1.0, 0.5, 1000.0, 9.81
K = math.pi / LENGTH
OMEGA = math.sqrt(G * K * math.tanh(K * DEPTH))
AMPLITUDE = 0.02 * DEPTH
SOUND = 15 * math.sqrt(2 * G * DEPTH)


def mode(x, z):
    """Velocity of the first mode, m/s, at its greatest."""
    scale = AMPLITUDE * OMEGA / math.sinh(K * DEPTH)
    return scale * np.column_stack([np.sin(K * x) * np.cosh(K * z), -np.cos(K * x) * np.sinh(K * z)])


def tank(cells, **scheme):
    dx = DEPTH / cells
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 10.0,
                "grid": {
                    "cell_size": dx,
                    "domain": {"x": [0.0, LENGTH], "z": [0.0, DEPTH + 2 * dx]},
                    "faces": {"x_min": "slip", "x_max": "slip", "z_min": "slip"},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [LENGTH, DEPTH]},
                        "material": {
                            "law": "newtonian",
                            "density": DENSITY,
                            "viscosity": 1e-3,
                            "sound_speed": SOUND,
                        },
                    }
                ],
                "scheme": scheme,
            }
        )
    )
    p = simulation.particles
    depth = DEPTH - p.position[:, 1]
    p.volume_ratio[:] = 1 / (1 + G * depth / SOUND**2)
    p.volume[:] = p.volume_ratio * p.initial_volume
    p.pressure[:] = DENSITY * G * depth
    p.velocity[:] = mode(p.position[:, 0], p.position[:, 1])
    return simulation


@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
def test_standing_wave(validate, order):
    simulation = tank(10, order=order)
    p = simulation.particles
    times, signal = [0.0], [1.0]
    size = np.sum(p.mass[:, None] * p.velocity**2)
    while simulation.time < 2.2 * 2 * math.pi / OMEGA:
        simulation.advance()
        shape = mode(p.position[:, 0], p.position[:, 1])
        signal.append(float(np.sum(p.mass[:, None] * shape * p.velocity) / size))
        times.append(simulation.time)
    t, s = np.array(times), np.array(signal)
    turn = np.flatnonzero(np.sign(s[:-1]) != np.sign(s[1:]))
    zeros = t[turn] - s[turn] * (t[turn + 1] - t[turn]) / (s[turn + 1] - s[turn])
    omega = math.pi * (len(zeros) - 1) / (zeros[-1] - zeros[0])
    name = f"Sloshing, {order.upper()}, 10 cells deep: omega²"
    validate(name, omega**2, close_to(G * K * math.tanh(K * DEPTH), rel=0.03), unit="1/s²")
    chart = validate.figure(
        "sloshing", "A standing wave in a tank", x="time (s)", y="velocity of the mode, of the first"
    )
    chart.reference("cos(omega t)", t, np.cos(OMEGA * t))
    chart.line(f"{order.upper()}, 10 cells deep", t, s)
