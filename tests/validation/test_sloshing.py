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
from accurate_setup import PAPER, scheme
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
                    "domain": {"x": [0.0, LENGTH], "z": [0.0, 2 * DEPTH]},
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


def slosh(cells, **numerics):
    """Times, the part of the mode in the velocity, and omega² from when that is zero, in two periods."""
    simulation = tank(cells, **numerics)
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
    return t, s, (math.pi * (len(zeros) - 1) / (zeros[-1] - zeros[0])) ** 2


def draw(validate, label, t, s):
    title, y = "A standing wave in a tank", "velocity of the mode, of the first"
    chart = validate.figure("sloshing", title, x="time (s)", y=y)
    chart.reference("cos(omega t)", t, np.cos(OMEGA * t))
    chart.line(label, t, s)


OTHERS = [pytest.param(order, marks=pytest.mark.slow) for order in ("usf", "musl")]


@pytest.mark.parametrize("order", ["usl", *OTHERS])
def test_standing_wave(validate, order):
    t, s, squared = slosh(10, **scheme(order=order))
    name = f"Sloshing, {order.upper()}, 10 cells deep: omega²"
    validate(name, squared, close_to(OMEGA**2, rel=0.03), unit="1/s²")
    if order == "usl":
        draw(validate, "accurate set-up, 10 cells deep", t, s)


def test_own_pressure_stiffens_the_wave():
    """By more than 3 % at 10 cells; the slow test below tells how this depends on the cell size, and why."""
    assert slosh(10, **PAPER)[2] / OMEGA**2 - 1 > 0.03


@pytest.mark.slow
def test_own_pressure_stiffens_the_wave_the_less_the_finer_the_cells(validate):
    """Each particle has its own volume and pressure: four constraints in a cell, more than linear functions
    can satisfy.

    A cell that bends, as under a wave, then has a volumetric strain of about k dx, with the stiffness rho c²:
    the relative error of omega² is proportional to (c dx)². This is volumetric locking.
    """
    excess = []
    for cells in (10, 20):
        t, s, squared = slosh(cells, **PAPER)
        excess.append(squared / OMEGA**2 - 1)
        draw(validate, f"own pressure, {cells} cells deep", t, s)
    assert excess[0] > 0.03
    name = "Sloshing, own pressure, locks: excess of omega² at 10 cells over that at 20"
    validate(name, excess[0] / excess[1], close_to(4.0, rel=0.1))


@pytest.mark.parametrize("periods", [3, pytest.param(14, marks=pytest.mark.slow)])
def test_a_tank_that_swings_for_long_keeps_its_volume(validate, periods):
    """A wave with an amplitude of a fifth of the depth; J follows from the positions of particles.

    If J is only moved towards its average, the water sinks to 0.89 of its depth in 14 periods, and without
    splitting to 0.6.
    """
    simulation = tank(10, splitting=True)
    p = simulation.particles
    p.velocity *= 0.1 / AMPLITUDE
    lowest = math.inf
    for period in range(1, periods + 1):
        while simulation.time < period * 2 * math.pi / OMEGA:
            simulation.advance()
        height = float(np.average(p.position[:, 1], weights=p.mass)) / (DEPTH / 2)
        lowest = min(lowest, height)
    name = f"A tank in {periods} periods: least height of its centre of mass over that at rest"
    validate(name, lowest, close_to(1.0, rel=0.02))
