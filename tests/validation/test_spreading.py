"""Newtonian sheets that spread under their own weight, on a slip floor and on a stick floor."""

from __future__ import annotations

import math

import numpy as np
import pytest
from accurate_setup import PAPER, scheme
from bands import close_to
from clock import at

import mpmkit

pytestmark = pytest.mark.section(4)

DENSITY, G = 1000.0, 9.81


def disc(radius, height, viscosity, floor, cells, far, factor, **numerics):
    """A round sheet, ``cells`` high."""
    dx = height / cells
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "axisymmetric",
                "until": 1e3,
                "grid": {
                    "cell_size": dx,
                    "domain": {"r": [0.0, math.ceil(far / dx) * dx], "z": [0.0, height + 2 * dx]},
                    "faces": {"z_min": floor},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [radius, height]},
                        "material": {
                            "law": "newtonian",
                            "density": DENSITY,
                            "viscosity": viscosity,
                            "sound_speed": {"factor": factor},
                        },
                    }
                ],
                "scheme": numerics,
            }
        )
    )


# USL bears half of the viscous limit inside a body; at a free edge it bears less.
PAPERS = PAPER | {"time_step": {"fraction": 0.25}}


@pytest.mark.parametrize(
    ("setup", "numerics", "until"),
    [
        pytest.param("paper", PAPERS, 0.6, marks=pytest.mark.slow),
        pytest.param("accurate", scheme(), 0.6, marks=pytest.mark.slow),
        ("accurate", scheme(), 0.3),
    ],
)
def test_free_slip_sheet_thins_at_its_rate(validate, setup, numerics, until):
    """v_r = e r with e = rho g H / (12 mu), away from the edge, and dH/dt = -2 e H.

    Over the height of a wide sheet without friction the mean radial stress is zero and the mean vertical
    stress -rho g H/2, and their difference is 6 mu e. So H = H0/(1 + rho g H0 t/(6 mu)). The edge has an
    influence over about one height inwards; momentum diffuses over the radius in rho R²/(pi² mu), 0.03 s.
    """
    radius, height, viscosity = 0.8, 0.1, 2000.0
    simulation = disc(radius, height, viscosity, "slip", 4, 1.2, 20, **numerics)
    p = simulation.particles
    weight = DENSITY * G / viscosity
    times = np.linspace(0.0, until, 21)
    rates, expected = [], []
    for t in at(simulation, times):
        inside = p.position[:, 0] < radius / 2
        r, v = p.position[inside, 0], p.velocity[inside, 0]
        rates.append(float(np.sum(p.mass[inside] * v * r) / np.sum(p.mass[inside] * r * r)))
        expected.append(weight * height / (1 + weight * height * t / 6) / 12)
    name = f"Newtonian sheet, slip floor, {setup} set-up"
    for k in (10, 20):
        row = f"{name}: thinning rate at {times[k]:g} s"
        validate(row, rates[k], close_to(expected[k], rel=0.05), unit="1/s")
    chart = validate.figure(
        "free_slip_sheet", "A Newtonian sheet on a slip floor", x="time (s)", y="rate of spreading e (1/s)"
    )
    chart.reference("rho g H / (12 mu)", times, expected)
    chart.points(f"mpmkit, {setup} set-up, 4 cells high, {until:g} s", times, rates)


@pytest.mark.parametrize(
    ("cells", "until"),
    [
        (8, 60),
        pytest.param(8, 100, marks=pytest.mark.slow),
        pytest.param(12, 100, marks=pytest.mark.slow),
    ],
)
def test_huppert(validate, cells, until):
    """R = 0.894 (g V³/(3 nu))^(1/8) t^(1/8) on a stick floor, Huppert, J. Fluid Mech. 121 (1982) 43-58.

    The sheet starts as a cylinder eight times as wide as high. The initial shape has no influence after many
    times T0, the time at which the similarity solution has the radius of the cylinder. Inertia, of the order
    (H/R)² Ga with Ga = g H³/nu², is then negligible. The steep edge remains as an error: it is ahead by a
    part of the height.
    """
    height, aspect, galilei = 0.1, 8, 1000
    radius, nu = aspect * height, math.sqrt(G * height**3 / galilei)
    volume = math.pi * radius**2 * height
    factor = 0.894 * (G * volume**3 / (3 * nu)) ** (1 / 8)
    scale = (radius / factor) ** 8
    simulation = disc(radius, height, DENSITY * nu, "stick", cells, 2 * radius, 6, **scheme())
    p, times, front = simulation.particles, scale * np.geomspace(2, until, 24), []
    for _ in at(simulation, times):
        front.append(float((p.position[:, 0] + p.box[:, 0]).max()))
    for k in (-4, -1):
        name = (
            f"Huppert spreading, stick floor, {cells} cells high at the start: R at {times[k] / scale:.0f} T0"
        )
        validate(name, front[k], close_to(factor * times[k] ** (1 / 8), rel=0.05), unit="m")
    chart = validate.figure(
        "huppert", "A Newtonian drop on a stick floor", x="time over T0", y="radius over the initial one",
        scale="log-log",
    )  # fmt: skip
    scaled = times / scale
    chart.reference("Huppert 1982", scaled, scaled ** (1 / 8))
    chart.points(f"mpmkit, {cells} cells high at the start, to {until} T0", scaled, np.array(front) / radius)
