"""The vibrating bar: what update orders and shape functions do to the energy of an elastic body.

A bar of L = 25, E = 100, rho = 1, fixed at x = 0 and free at x = L, starts with v = v0 sin(pi x / 2 L), its
first mode: period 4 L / c = 10 s. With nu = 0 the plane-strain scene, one row of cells between planes of
symmetry, is the one-dimensional bar. Its energy after 100 s over the initial one is compared with an
independent 1-D code (targets, section 5). At that instant the bar is straight, so that kinetic and strain
energy being half a step apart in some orders does not matter.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import between, close_to

import mpmkit
from mpmkit.errors import GuardStop

pytestmark = pytest.mark.section(5)

LENGTH, MODULUS, DENSITY, SPEED, UNTIL = 25.0, 100.0, 1.0, 0.1, 100.0
ENERGY = DENSITY * SPEED**2 * LENGTH / 4  # a unit of cross-section
TABLE = {
    (13, 1, "linear"): {"usf": 1.0018, "usl": 0.9955, "musl": 0.9982},
    (13, 1, "cpgimp"): {"usf": 1.0019, "usl": 0.9702, "musl": 0.9981},
    (50, 2, "linear"): {"usf": 1.0147, "usl": math.inf, "musl": 0.9951},
    (50, 2, "cpgimp"): {"usf": 1.0000, "usl": 0.9999, "musl": 1.0000},
}


def bar(cells, particles, shape, order):
    dx = LENGTH / cells
    case = mpmkit.parse_case(
        {
            "space": "plane-strain",
            "until": UNTIL,
            "gravity": [0.0, 0.0],
            "grid": {
                "cell_size": dx,
                "domain": {"x": [0.0, (cells + 2) * dx], "z": [0.0, dx]},
                "faces": {"x_min": "symmetry", "z_min": "symmetry", "z_max": "symmetry"},
            },
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [LENGTH, dx]},
                    "material": {
                        "law": "neo-hookean",
                        "density": DENSITY,
                        "youngs_modulus": MODULUS,
                        "poisson_ratio": 0.0,
                    },
                    "particles_per_cell": [particles, 1],
                    "velocity": {"amplitude": [SPEED, 0.0], "wave_vector": [math.pi / (2 * LENGTH), 0.0]},
                }
            ],
            "scheme": {"shape": shape, "order": order, "velocity": "flip", "time_step": {"fraction": 0.1}},
        }
    )
    return mpmkit.Simulation(case)


def energy(simulation):
    """Kinetic and strain energy, over the exact initial energy of the bar."""
    found = simulation.measures(simulation.particles)
    return (found["kinetic_energy"] + found["strain_energy"]) / (ENERGY * simulation.grid.cell_size)


def vibrate(cells, particles, shape, order, until=UNTIL, chart=None):
    """Energy ratio at ``until``, s, and the largest of the run; infinity and the time if the run diverges."""
    simulation = bar(cells, particles, shape, order)
    largest = energy(simulation)
    times, energies = [0.0], [largest]
    with np.errstate(all="ignore"):
        while simulation.time < until - 1e-9:
            try:
                simulation.advance(at_most=until - simulation.time)
                if simulation.steps % 20 == 0:
                    times.append(simulation.time)
                    energies.append(energy(simulation))
                    largest = max(largest, energies[-1])
                    if not largest < 2:
                        return math.inf, math.inf, simulation.time
            except GuardStop:
                return math.inf, math.inf, simulation.time
    if chart is not None:
        chart.line(order.upper(), times, energies)
    return energy(simulation), largest, simulation.time


def energy_after(scheme, order):
    return f"Bar, {scheme}, {order.upper()}: energy after 10 periods over the initial one"


def test_step_period_and_initial_energy(validate):
    simulation = bar(50, 2, "cpgimp", "usl")
    assert simulation.time_step == pytest.approx(0.1 * 0.5 / 10.0, rel=1e-12)
    validate("Bar: initial energy over 0.0625", energy(simulation), close_to(1.0, abs=1e-4))
    p = simulation.particles
    shape = p.mass * np.sin(math.pi * p.position[:, 0] / (2 * LENGTH))
    amplitude, times = [], []
    while simulation.time < 11.0:
        simulation.advance()
        amplitude.append(float(np.sum(shape[np.argsort(p.number)] * p.velocity[np.argsort(p.number), 0])))
        times.append(simulation.time)
    amplitude = np.array(amplitude)
    zeros = np.flatnonzero(np.sign(amplitude[:-1]) != np.sign(amplitude[1:]))
    fractions = amplitude[zeros] / (amplitude[zeros] - amplitude[zeros + 1])
    found = np.array(times)[zeros] + fractions * simulation.time_step
    for quarters, zero in zip((1, 3), found, strict=True):
        validate(f"Bar: {quarters}/4 of the period", zero, close_to(2.5 * quarters, rel=5e-3), unit="s")


@pytest.mark.slow
@pytest.mark.parametrize("order", ["usf", "musl", "usl"])
def test_energy_with_cpgimp_at_50_cells(validate, order):
    ratio, largest, _ = vibrate(50, 2, "cpgimp", order)
    name = energy_after("50 cells, 2 particles, cpGIMP", order)
    validate(name, ratio, close_to(TABLE[50, 2, "cpgimp"][order], abs=1e-3))
    assert largest < 1.01


@pytest.mark.parametrize("shape", [pytest.param("linear", marks=pytest.mark.slow), "cpgimp"])
def test_energy_at_13_cells(validate, shape):
    """USL loses energy and USF gains energy; no particle crosses a cell."""
    title = "Energy of the vibrating bar, 13 cells, 1 particle"
    chart = validate.figure(
        f"bar_{shape}", f"{title}, {shape}", x="time (s)", y="energy over the initial one"
    )
    chart.reference("exact", [0, UNTIL], [1, 1])
    found = {order: vibrate(13, 1, shape, order, chart=chart)[0] for order in ("usf", "usl", "musl")}
    assert found["usl"] < 1 < found["usf"]
    for order, ratio in found.items():
        name = energy_after(f"13 cells, 1 particle, {shape}", order)
        validate(name, ratio, close_to(TABLE[13, 1, shape][order], abs=1e-3))


def test_usl_with_linear_functions_blows_up_where_cells_are_crossed(validate):
    """A nearly empty node ejects the particle that entered its cell: the energy doubles, or is not finite."""
    ratio, _, when = vibrate(50, 2, "linear", "usl")
    assert math.isinf(ratio)
    name = "Bar, 50 cells, 2 particles, linear, USL: blows up, at"
    validate(name, when, close_to(1.5, abs=0.1), unit="s")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("order", "low", "high"),
    [("usf", 1.003, 1.02), ("musl", 0.985, 0.998)],
)
def test_cell_crossing_with_linear_functions_is_noise(validate, order, low, high):
    """Here two codes agree in sign and size alone (1.0147 and 0.9951 in the table, 1.0076 and 0.9937 found).

    Which particle crosses when depends on the last digits, and every crossing is a jump of the force.
    """
    name = energy_after("50 cells, 2 particles, linear", order)
    expected = f"{TABLE[50, 2, 'linear'][order]:.4f}, with noise"
    validate(name, vibrate(50, 2, "linear", order)[0], between(low, high, expected))
