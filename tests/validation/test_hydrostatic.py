"""A column of fluid at rest: p = rho g (H - z), and nothing flows.

A Newtonian column in a slip tube starts without pressure at t = 0 and settles under its own weight: acoustic
oscillations of wave number k = pi / 2 H decay at the rate 2/3 mu k² / rho. With H = 0.5 m and mu = 1000 Pa·s
the rate is 6.6 /s, so that the amplitude after 1.4 s is 1e-4 of the first one; all other motion comes from
the method itself.

Two particles in one cell have the same volumetric rate, so that the pressure is constant in a cell and not
linear: it is a staircase, ± rho g dx/4 about the exact line, which is 1.25 % of rho g H at 20 cells.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from accurate_setup import SCHEME
from bands import below, close_to

import mpmkit
from mpmkit.kernels.scatter import CONTACT
from mpmkit.registry import installed
from mpmkit.solver.particle_fields import mean_pressure

pytestmark = pytest.mark.section(4)

HEIGHT, WIDTH, DENSITY, VISCOSITY, G = 0.5, 0.05, 1000.0, 1000.0, 9.81
FREE_FALL = math.sqrt(2 * G * HEIGHT)
SOUND = 10 * FREE_FALL
DECAY = 2 / 3 * VISCOSITY / DENSITY * (math.pi / (2 * HEIGHT)) ** 2
SETTLED = math.log(1e4) / DECAY
CELLS = 20
SPACES = ("plane-strain", "axisymmetric")
ONE_FAST = (pytest.param("plane-strain", marks=pytest.mark.slow), "axisymmetric")
"""In the default run the space with more terms stands for both."""


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
    return let_go(mpmkit.Simulation(case))


def let_go(simulation):
    """Remove the pressure that a simulation gives a column in a tube, so that the column settles."""
    p = simulation.particles
    p.volume_ratio[:], p.volume[:], p.pressure[:] = 1.0, p.initial_volume, 0.0
    return simulation


def settle(simulation, until=SETTLED):
    while simulation.time < until:
        simulation.advance()
    return simulation


@cache
def long_settled(space):
    """State of a column of 10 cells that has been at rest for long; tests continue from it."""
    return settle(column(space, cells=10), 3 * SETTLED).state()


def at_rest(space):
    """A simulation that continues from that state."""
    simulation = column(space, cells=10)
    simulation.restore(long_settled(space))
    return simulation


@cache
def settled(space):
    """The column of the default schemes at rest, which tests must not change, and its values at the start."""
    simulation = column(space)
    start = simulation.measures(simulation.particles)
    return settle(simulation), start


def check_pressure(validate, simulation, name):
    """Within 2 % of rho g H at inner particles, and within 2 % of the local value in every deep layer."""
    p, dx = simulation.particles, simulation.grid.cell_size
    depth = HEIGHT - p.position[:, 1]
    inside = (p.position[:, 1] > dx) & (depth > dx)
    pressure = mean_pressure(p)
    error = pressure - DENSITY * G * depth
    worst = np.abs(error[inside]).max() / (DENSITY * G * HEIGHT)
    validate(f"Hydrostatic column, {name}: particle pressure, error over rho g H", worst, below(0.02, "0"))
    layer = (p.position[:, 1] / dx).astype(int)
    deep = range(1, round(HEIGHT / dx) - 5)
    means = [pressure[layer == k].mean() / (DENSITY * G * depth[layer == k].mean()) for k in deep]
    worst = max(abs(mean - 1) for mean in means)
    validate(f"Hydrostatic column, {name}: pressure of a layer, relative error", worst, below(0.02, "0"))


def check_rest(validate, simulation, name, bound):
    found = simulation.measures(simulation.particles)
    speed = found["max_speed"] / FREE_FALL
    validate(f"Hydrostatic column, {name}: spurious speed over that of free fall", speed, below(bound, "0"))
    stress = np.abs(simulation.particles.stress).max()
    assert stress < 1e-3 * DENSITY * G * HEIGHT


SCHEMES = [("cpgimp", order) for order in installed().of_kind("order")] + [("linear", "musl")]
IN_THE_DEFAULT_RUN = {
    ("axisymmetric", "cpgimp", "usl"),
    ("plane-strain", "cpgimp", "usf"),
    ("axisymmetric", "linear", "musl"),
}
"""Every space, shape and order once; PIC rests in plane strain with USL, see below."""


def schemes_and_spaces():
    for space in SPACES:
        for shape, order in SCHEMES:
            again = (space, shape, order) not in IN_THE_DEFAULT_RUN
            yield pytest.param(space, shape, order, marks=pytest.mark.slow if again else ())


@pytest.mark.parametrize(("space", "shape", "order"), list(schemes_and_spaces()))
def test_column_comes_to_rest_under_its_weight(validate, space, shape, order):
    default = (shape, order) == ("cpgimp", "usl")
    simulation = settled(space)[0] if default else settle(column(space, shape, order))
    check_pressure(validate, simulation, space)
    check_rest(validate, simulation, space, 1e-4)
    if default:
        draw_pressure(validate, simulation, f"own pressure, {space}")


def draw_pressure(validate, simulation, name):
    p, bottom = simulation.particles, DENSITY * G * HEIGHT
    title = "A column of fluid at rest"
    chart = validate.figure("hydrostatic", title, x="pressure (Pa)", y="height (m)")
    chart.reference("rho g (H - z)", [bottom, 0.0], [0.0, HEIGHT])
    cells = round(HEIGHT / simulation.grid.cell_size)
    chart.points(f"{name}, {cells} cells", mean_pressure(p), p.position[:, 1])


@pytest.mark.parametrize("space", ONE_FAST)
def test_accurate_setup_rests_as_well(validate, space):
    """A pressure averaged through the grid is a straight line, not a staircase: 10 cells are enough."""
    simulation = settle(column(space, velocity=SCHEME["velocity"], cells=10, volumetric=SCHEME["volumetric"]))
    check_pressure(validate, simulation, f"{space}, accurate set-up")
    check_rest(validate, simulation, f"{space}, accurate set-up", 1e-4)
    draw_pressure(validate, simulation, f"accurate set-up, {space}")


@pytest.mark.parametrize(
    ("space", "velocity"),
    [("plane-strain", "pic"), pytest.param("axisymmetric", "blend", marks=pytest.mark.slow)],
)
def test_dissipative_updates_rest_as_well(validate, space, velocity):
    simulation = settle(column(space, velocity=velocity))
    check_pressure(validate, simulation, f"{space}, {velocity}")
    check_rest(validate, simulation, f"{space}, {velocity}", 1e-5)


@pytest.mark.parametrize("space", ONE_FAST)
def test_rest_lasts(validate, space):
    """For the same time again, nothing moves and the energy does not grow.

    With FLIP a little particle velocity remains that has no effect on the grid and moves nothing. Boxes of
    equal sides have a mode that decays by a factor of 13 in twice ``SETTLED``; the test waits until it is
    gone.
    """
    simulation = at_rest(space)
    p = simulation.particles
    speed = simulation.measures(p)["max_speed"]
    start = p.position[np.argsort(p.number)].copy()
    settle(simulation, 6 * SETTLED)
    assert simulation.measures(p)["max_speed"] < 1.01 * speed
    moved = np.abs(p.position[np.argsort(p.number)] - start).max() / HEIGHT
    validate(f"Hydrostatic column, {space}: moved over H, for as long again", moved, below(1e-7, "0"))


@pytest.mark.section(6)
@pytest.mark.parametrize("space", ONE_FAST)
def test_contact_does_not_flicker_at_rest(validate, space):
    """A column in a tube, touching floor and walls, in 1000 steps once it is at rest."""
    simulation = at_rest(space)
    window = simulation.operations.window
    before, changes = window.nodes[:, CONTACT].copy(), 0
    for _ in range(1000):
        simulation.advance()
        changes += int((window.nodes[:, CONTACT] != before).sum())
        before[:] = window.nodes[:, CONTACT]
    assert before.any()
    validate(f"Column at rest, {space}: changes of contact in 1000 steps", changes, below(0, "0"))


@pytest.mark.parametrize("space", ONE_FAST)
def test_energies_of_the_settled_column(validate, space):
    """The column sinks as a linear spring does: half of the potential energy that it loses is stored."""
    simulation, start = settled(space)
    area = math.pi * WIDTH**2 if space == "axisymmetric" else WIDTH
    assert start["total_mass"] == pytest.approx(DENSITY * area * HEIGHT, rel=1e-12)
    assert start["potential_energy"] == pytest.approx(DENSITY * area * G * HEIGHT**2 / 2, rel=1e-9)
    end = simulation.measures(simulation.particles)
    stored = area * (DENSITY * G) ** 2 * HEIGHT**3 / (6 * DENSITY * SOUND**2)
    name, sunk = f"Settled column, {space}", G * HEIGHT**2 / (2 * SOUND**2)
    given_up = start["potential_energy"] - end["potential_energy"]
    validate(f"{name}: stored energy", end["compressive_energy"], close_to(stored, rel=0.01), unit="J")
    validate(f"{name}: potential energy given up", given_up, close_to(2 * stored, rel=0.01), unit="J")
    validate(f"{name}: sunk", start["height"] - end["height"], close_to(sunk, rel=0.02), unit="m")


@pytest.mark.parametrize("space", SPACES)
def test_settling_period(validate, space):
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
    name = f"Settling column, {space}: half a period"
    validate(name, times[turn], close_to(math.pi / damped, rel=0.03), unit="s")
