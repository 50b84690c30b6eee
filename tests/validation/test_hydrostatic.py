"""A column of fluid at rest: p = rho g (H - z), and nothing flows.

A Newtonian column in a slip tube is let go at t = 0 and settles to its own weight: acoustic oscillations of
wave number k = pi / 2 H decay at the rate 2/3 mu k² / rho. With H = 0.5 m and mu = 1000 Pa·s it is 6.6 /s,
so that 1.4 s take them down by 1e-4; what is left is what the method itself does.

Two particles that share a cell see the same volumetric rate, so that the pressure is constant in a cell and
not linear: it is a staircase, ± rho g dx/4 about the exact line, which is 1.25 % of rho g H at 20 cells.
"""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

import mpmkit
from mpmkit.registry import installed

HEIGHT, WIDTH, DENSITY, VISCOSITY, G = 0.5, 0.05, 1000.0, 1000.0, 9.81
FREE_FALL = math.sqrt(2 * G * HEIGHT)
SOUND = 10 * FREE_FALL
DECAY = 2 / 3 * VISCOSITY / DENSITY * (math.pi / (2 * HEIGHT)) ** 2
SETTLED = math.log(1e4) / DECAY
CELLS = 20
SPACES = ("plane-strain", "axisymmetric")


@pytest.fixture(autouse=True)
def _one_thread():
    numba.set_num_threads(1)


def column(space, shape="cpgimp", order="usl", velocity="flip", cells=CELLS, volumetric="own"):
    dx = HEIGHT / cells
    side = "r" if space == "axisymmetric" else "x"
    faces = {f"{side}_max": "slip", "z_min": "slip"}
    if side == "x":
        faces["x_min"] = "slip"
    case = mpmkit.parse_case(
        {
            "space": space,
            "until": 10.0,
            "grid": {
                "cell_size": dx,
                "domain": {side: [0.0, WIDTH], "z": [0.0, HEIGHT + 4 * dx]},
                "faces": faces,
            },
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [WIDTH, HEIGHT]},
                    "material": {
                        "law": "newtonian",
                        "density": DENSITY,
                        "viscosity": VISCOSITY,
                        "sound_speed": SOUND,
                    },
                }
            ],
            "scheme": {
                "shape": shape,
                "order": order,
                "velocity": velocity,
                "volumetric": volumetric,
                "time_step": {"fraction": 0.5},
            },
        }
    )
    return mpmkit.Simulation(case)


def settle(simulation, until=SETTLED):
    while simulation.time < until:
        simulation.advance()
    return simulation


def check_pressure(simulation):
    """Within 2 % of rho g H at every particle inside, of the local value in the mean of every deep layer."""
    p, dx = simulation.particles, simulation.grid.cell_size
    depth = HEIGHT - p.position[:, 1]
    inside = (p.position[:, 1] > dx) & (depth > dx)
    error = p.pressure - DENSITY * G * depth
    assert np.abs(error[inside]).max() < 0.02 * DENSITY * G * HEIGHT
    layer = (p.position[:, 1] / dx).astype(int)
    for k in range(1, round(HEIGHT / dx) - 5):
        exact = DENSITY * G * depth[layer == k].mean()
        assert p.pressure[layer == k].mean() == pytest.approx(exact, rel=0.02)


def check_rest(simulation, bound):
    found = simulation.measures(simulation.particles)
    assert found["max_speed"] < bound * FREE_FALL
    stress = np.abs(simulation.particles.stress).max()
    assert stress < 1e-3 * DENSITY * G * HEIGHT


SCHEMES = [("cpgimp", order) for order in installed().of_kind("order")] + [("linear", "musl")]


@pytest.mark.parametrize(("shape", "order"), SCHEMES)
@pytest.mark.parametrize("space", SPACES)
def test_column_comes_to_rest_under_its_weight(space, shape, order):
    simulation = settle(column(space, shape, order))
    check_pressure(simulation)
    check_rest(simulation, 1e-4)


@pytest.mark.parametrize(("space", "velocity"), [("plane-strain", "pic"), ("axisymmetric", "blend")])
def test_dissipative_updates_rest_as_well(space, velocity):
    simulation = settle(column(space, velocity=velocity))
    check_pressure(simulation)
    check_rest(simulation, 1e-5)


@pytest.mark.parametrize("space", SPACES)
def test_rest_lasts(space):
    """For as long again, nothing moves and no energy is fed in.

    With FLIP a trace of particle velocity stays that the grid does not see, and that moves nothing.
    """
    simulation = settle(column(space, cells=10), 2 * SETTLED)
    p = simulation.particles
    speed = simulation.measures(p)["max_speed"]
    start = p.position[np.argsort(p.number)].copy()
    settle(simulation, 4 * SETTLED)
    assert simulation.measures(p)["max_speed"] < 1.01 * speed
    assert np.abs(p.position[np.argsort(p.number)] - start).max() < 1e-7 * HEIGHT


@pytest.mark.parametrize("space", SPACES)
def test_energies_of_the_settled_column(space):
    """It sinks as a linear spring: of the potential energy given up, half is stored, E = ∫ p² / 2 rho c²."""
    simulation = column(space)
    start = simulation.measures(simulation.particles)
    area = math.pi * WIDTH**2 if space == "axisymmetric" else WIDTH
    assert start["total_mass"] == pytest.approx(DENSITY * area * HEIGHT, rel=1e-12)
    assert start["potential_energy"] == pytest.approx(DENSITY * area * G * HEIGHT**2 / 2, rel=1e-9)
    settle(simulation)
    end = simulation.measures(simulation.particles)
    stored = area * (DENSITY * G) ** 2 * HEIGHT**3 / (6 * DENSITY * SOUND**2)
    assert end["compressive_energy"] == pytest.approx(stored, rel=0.01)
    assert start["potential_energy"] - end["potential_energy"] == pytest.approx(2 * stored, rel=0.01)
    sunk = G * HEIGHT**2 / (2 * SOUND**2)
    assert start["height"] - end["height"] == pytest.approx(sunk, rel=0.02)


@pytest.mark.parametrize("space", SPACES)
def test_settling_period(space):
    """The damped oscillator of the first mode: omega² = (pi c / 2 H)² - (2/3 mu k² / rho)²."""
    simulation = column(space, order="musl")
    p = simulation.particles
    momentum, times = [], []
    while simulation.time < 6 * HEIGHT / SOUND:
        simulation.advance()
        momentum.append(float(p.mass @ p.velocity[:, 1]))
        times.append(simulation.time)
    turn = int(np.argmax(np.array(momentum) > 0))  # half a period: the column stops falling
    omega = math.pi * SOUND / (2 * HEIGHT)
    damped = math.sqrt(omega**2 - DECAY**2)
    assert times[turn] == pytest.approx(math.pi / damped, rel=0.03)
