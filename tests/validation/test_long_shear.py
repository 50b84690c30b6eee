"""Flows with long shear: speed, height and volume of the material stay right.

Shear changes the neighbours of particles. Without a redistribution, their boxes, volumes and positions then
contradict each other, and a steady film slows down to 0.67 of its speed in 9.6 s and to 0.44 in 12 s. All
scenes here have the default scheme.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from accurate_setup import bingham
from bands import below, between, close_to
from channel import Fluid, down_slope
from clock import at

import mpmkit
from mpmkit.solver.simulation import Simulation

pytestmark = pytest.mark.section(5)

THICK, SOUND = 0.05, 20.0
"""Thickness of the films, m, and their speed of sound, m/s."""
SLIP = dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "slip")
STOPS = 20
"""Times at which a long run is looked at."""


def scene(**parts: Any) -> Simulation:
    return mpmkit.Simulation(mpmkit.parse_case({"space": "plane-strain", **parts}))


def mean_of(simulation: Simulation, values: np.ndarray) -> float:
    """The mean of a particle field by mass."""
    p = simulation.particles
    return float(p.mass @ values / p.mass.sum())


def box(lower: list[float], upper: list[float], material: dict[str, Any]) -> list[dict[str, Any]]:
    return [{"shape": {"kind": "box", "lower": lower, "upper": upper}, "material": material}]


# --- Films

MORTAR = Fluid(yield_stress=40.0, consistency=20.0, density=2300.0)
CONCRETE = Fluid(yield_stress=188.91, consistency=45.65, flow_index=1.33, density=2574.0)
SYRUP = Fluid(yield_stress=0.0, consistency=4.5, density=2300.0)
GREASE = Fluid(yield_stress=650.0, consistency=20.6, flow_index=0.605, density=2300.0)
slow = pytest.mark.slow
FILMS = {
    "mortar, 30°": (MORTAR, 30.0, 4, 1.5),
    "mortar, 30°, long": (MORTAR, 30.0, 4, 40.0),
    "mortar, 30°, 7 cells": (MORTAR, 30.0, 7, 30.0),
    "concrete, 20°": (CONCRETE, 20.0, 4, 20.0),
    "Newtonian, 20°": (SYRUP, 20.0, 4, 30.0),
    "grease, 90°": (GREASE, 90.0, 4, 10.0),
}
"""Fluid, slope, cells of the period, and the time at the end, s."""


def film(fluid: Fluid, degrees: float, cells: int, until: float, cell: float = 0.005) -> Simulation:
    """A film on a stick floor that starts from rest, periodic over a few cells."""
    drive, across = down_slope(fluid.density, degrees)
    return scene(
        until=until,
        gravity=[drive / fluid.density, -across],
        grid={
            "cell_size": cell,
            "domain": {"x": [0, cells * cell], "z": [0, 1.5 * THICK]},
            "faces": {"z_min": "stick", "x_min": "periodic", "x_max": "periodic"},
        },
        bodies=box([0, 0], [cells * cell, THICK], fluid.material(sound_speed=SOUND)),
    )


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name == "mortar, 30°" else slow) for name in FILMS]
)
def test_a_film_keeps_its_speed_its_height_and_its_density(validate, name):
    """Tested at several times when the film is steady.

    By 12 s the surface of the mortar has moved 7 m, 360 times the length of the scene, and the shear at the
    floor is 220. The height is taken as twice that of the centre of mass, since single particles may lie on a
    Newtonian surface.
    """
    fluid, degrees, cells, until = FILMS[name]
    simulation = film(fluid, degrees, cells, until)
    p, number, mass = simulation.particles, len(simulation.particles), simulation.particles.mass.sum()
    drive, _ = down_slope(fluid.density, degrees)
    exact = fluid.half_discharge(drive, THICK) / THICK
    shear, speed, height, density, across = [], [], [], [], []
    for time in at(simulation, np.linspace(0, until, STOPS + 1)[1:]):
        shear.append(exact * time / THICK)
        across.append(mean_of(simulation, p.velocity[:, 1]) / exact)
        speed.append(mean_of(simulation, p.velocity[:, 0]) / exact)
        height.append(2 * mean_of(simulation, p.position[:, 1]) / THICK)
        density.append(simulation.measures(p)["density_mean"])
    simulation.check()
    figure = validate.figure(
        "long_shear", "Films that go on", x="mean displacement over thickness", y="mean speed over exact"
    )
    figure.line(name, np.array(shear), np.array(speed))
    late = slice(STOPS // 2, None) if until < 5 else slice(STOPS // 4, None)
    for text, values, rel in (
        ("mean speed over exact", speed, 0.01),
        ("height over exact", height, 0.005),
        ("density inside over the material's", density, 0.02),
    ):
        worst = max(values[late], key=lambda value: abs(value - 1))
        validate(f"Film, {name}, {until:g} s: {text}, worst", worst, close_to(1.0, rel=rel))
    assert len(p) == number
    assert p.mass.sum() == mass
    # Nothing drives it across the floor; what there is at a moment, 1e-3, is sound, and its mean is none.
    assert abs(np.mean(across[late])) < 1e-3


# --- A pipe

RADIUS, PIPE_STRESS, PIPE_VISCOSITY, PIPE_DENSITY = 0.0125, 200.0, 10.0, 2300.0


def buckingham_reiner(drive: float) -> float:
    """Mean speed, m/s, of a Bingham fluid in a pipe: G R²/8μ (1 - 4/3 φ + φ⁴/3), φ = 2 τ0/(G R)."""
    plug = 2 * PIPE_STRESS / (drive * RADIUS)
    return drive * RADIUS**2 / (8 * PIPE_VISCOSITY) * (1 - 4 / 3 * plug + plug**4 / 3)


@pytest.mark.parametrize("until", [0.2, pytest.param(10.0, marks=slow)])
def test_a_pipe_keeps_its_speed(validate, until):
    """A Bingham fluid that gravity drives along a pipe, periodic, ten cells in the radius."""
    drive, cell = 93.5e3, RADIUS / 10
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "axisymmetric",
                "until": until,
                "gravity": [0.0, drive / PIPE_DENSITY],
                "grid": {
                    "cell_size": cell,
                    "domain": {"r": [0, RADIUS], "z": [0, 4 * cell]},
                    "faces": {"r_max": "stick", "z_min": "periodic", "z_max": "periodic"},
                },
                "bodies": [
                    {
                        "shape": {"kind": "cylinder", "radius": RADIUS, "height": 4 * cell},
                        "material": bingham(
                            PIPE_STRESS, PIPE_VISCOSITY, density=PIPE_DENSITY, sound_speed=10.0
                        ),
                    }
                ],
            }
        )
    )
    exact, speed = buckingham_reiner(drive), []
    for _ in at(simulation, np.linspace(0, until, STOPS + 1)[1:]):
        speed.append(mean_of(simulation, simulation.particles.velocity[:, 1]) / exact)
    worst = max(speed[STOPS // 2 :], key=lambda value: abs(value - 1))
    validate(f"Pipe, {until:g} s: mean speed over exact, worst", worst, close_to(1.0, rel=0.01))


# --- Tanks


@pytest.mark.parametrize(
    ("yield_stress", "viscosity", "density"),
    [pytest.param(40.0, 20.0, 2300.0, marks=slow), pytest.param(10.0, 1.0, 1900.0, marks=slow)],
)
def test_material_released_in_a_tank_keeps_its_volume(validate, yield_stress, viscosity, density):
    """The centre of mass stays within 0.5 % of that of a flat pool; 0.3 % are compression by its own weight.

    Without a redistribution it sinks to 0.764 of that height, or with thinner mortar to 0.62.
    """
    width, height, length, until = 0.56, 0.28, 1.5, 5.0
    simulation = scene(
        until=until,
        grid={"cell_size": 0.02, "domain": {"x": [0, length], "z": [0, 1.0]}, "faces": SLIP},
        bodies=box(
            [0, 0],
            [width, height],
            bingham(yield_stress, viscosity, density=density, sound_speed={"factor": 10}),
        ),
    )
    p, number, spread = simulation.particles, len(simulation.particles), []
    for _ in at(simulation, np.linspace(0, until, STOPS + 1)[1:]):
        spread.append(simulation.measures(p)["spread_diameter"])
    simulation.check()
    found = mean_of(simulation, p.position[:, 1]) / (width * height / length / 2)
    name = f"Closed tank, {yield_stress:g} Pa, {viscosity:g} Pa s, {until:g} s"
    validate(f"{name}: centre of mass over flat", found, between(0.995, 1.05))
    validate(f"{name}: largest spread over the length", max(spread) / length, below(1.0))
    assert len(p) == number


@pytest.mark.slow
def test_water_that_swings_for_long_keeps_its_volume(validate):
    """A hundred periods of the first wave. Without a redistribution the water sinks to half of its height."""
    length, depth, cell, gravity = 0.4, 0.2, 0.02, 9.81
    k = math.pi / length
    until = 100 * 2 * math.pi / math.sqrt(gravity * k * math.tanh(k * depth))
    water = {"law": "newtonian", "density": 1000.0, "viscosity": 1e-3, "sound_speed": {"factor": 10}}
    simulation = scene(
        until=until,
        grid={"cell_size": cell, "domain": {"x": [0, length], "z": [0, 2 * depth]}, "faces": SLIP},
        bodies=[
            box([0, 0], [length, depth], water)[0]
            | {"velocity": {"amplitude": [0.2, 0.0], "wave_vector": [k, 0.0]}}
        ],
    )
    p, number = simulation.particles, len(simulation.particles)
    found = [mean_of(simulation, p.position[:, 1]) for _ in at(simulation, np.linspace(0, until, 101)[1:])]
    simulation.check()
    lowest = min(found[-20:]) / (depth / 2)
    validate("Water in a tank, 100 periods: lowest centre of mass over flat", lowest, between(0.98, 1.02))
    assert len(p) == number


@pytest.mark.slow
def test_concrete_lies_still_in_the_channel_of_an_l_box(validate):
    """A column is released in a box 0.8 m long and comes to rest from wall to wall."""
    length, width, height = 0.8, 0.2, 0.4
    simulation = scene(
        until=5.0,
        grid={"cell_size": 0.02, "domain": {"x": [0, length], "z": [0, 0.6]}, "faces": SLIP},
        bodies=box([0, 0], [width, height], bingham(100.0, 30.0, density=2300.0, sound_speed={"factor": 10})),
    )
    for _ in at(simulation, [5.0]):
        pass
    p, flat = simulation.particles, width * height / length / 2
    validate(
        "Channel of an L-box, 5 s: centre of mass over flat",
        mean_of(simulation, p.position[:, 1]) / flat,
        between(0.995, 1.05),
    )
    spread = simulation.measures(p)["spread_diameter"]
    validate("Channel of an L-box, 5 s: spread", spread, close_to(length, rel=1e-3), unit="m")
