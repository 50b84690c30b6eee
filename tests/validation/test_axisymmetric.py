"""Axisymmetric scenes: u_r = e r is exactly a uniform expansion, at the axis too; mass of rings."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import below, close_to

import mpmkit
from mpmkit.errors import CaseError
from mpmkit.registry import installed

pytestmark = pytest.mark.section(5)

REGISTRY = installed()
SHAPES = list(REGISTRY.of_kind("shape"))
RUBBER = {"law": "neo-hookean", "density": 1000.0, "youngs_modulus": 1e5, "poisson_ratio": 0.3}
DX = 0.05

each_shape = pytest.mark.parametrize("shape", SHAPES)


def scene(shape, body, per_cell=4, order="usl", velocity="flip", domain=None, gravity=None, fraction=0.2):
    case = mpmkit.parse_case(
        {
            "space": "axisymmetric",
            "until": 1.0,
            "gravity": gravity or [0.0, 0.0],
            "grid": {"cell_size": DX, "domain": domain or {"r": [0.0, 1.0], "z": [-1.0, 1.0]}},
            "bodies": [{"shape": body, "material": RUBBER, "particles_per_cell": per_cell}],
            "scheme": {
                "shape": shape,
                "order": order,
                "velocity": velocity,
                "time_step": {"fraction": fraction},
            },
        }
    )
    return mpmkit.Simulation(case)


CYLINDER = {"kind": "box", "lower": [0.0, -0.2], "upper": [0.4, 0.2]}
BALL = {"kind": "sphere", "centre": [0.0, 0.0], "radius": 0.3}


def node_radii(simulation):
    window = simulation.operations.window
    i = np.arange(window.shape[0]) + window.lower[0]
    return np.repeat(i * DX, window.shape[1] * window.shape[2])


def set_nodes(simulation, radial, axial=0.0):
    """Write nodal velocities of a linear field, where there are nodes."""
    nodes = simulation.operations.window.nodes
    nodes[:, 1], nodes[:, 2] = radial, axial


@each_shape
@pytest.mark.parametrize("per_cell", [1, 4, 9, [3, 2]], ids=str)
@pytest.mark.parametrize("body", [CYLINDER, BALL], ids=["cylinder", "ball"])
def test_patch(validate, shape, per_cell, body):
    """v_r = e r at the nodes: D_rr = D_θθ = e to 1e-12 at every particle, at the axis too."""
    simulation = scene(shape, body, per_cell)
    rate = 0.7
    ops, p = simulation.operations, simulation.particles
    assert ops.begin() is None
    ops.map_to_grid()
    set_nodes(simulation, rate * node_radii(simulation))
    ops.update_velocity_gradient()
    expected = np.zeros((len(p), 3, 3))
    expected[:, 0, 0] = expected[:, 2, 2] = rate
    assert p.position[:, 0].min() < DX  # there are particles at the axis
    off = np.abs(p.velocity_gradient - expected).max() / rate
    name = f"Axisymmetric patch u_r = e r, {shape}: D_rr and D_θθ off e, the axis included"
    validate(name, off, below(1e-12, "0"))


@each_shape
def test_uniform_expansion_moves_every_ring_in_proportion(shape):
    """r ← r (1 + e dt) for every particle, so that a uniform expansion stays one."""
    simulation = scene(shape, CYLINDER)
    rate, dt = 0.7, 0.01
    ops, p = simulation.operations, simulation.particles
    ops.begin()
    ops.map_to_grid()
    set_nodes(simulation, rate * node_radii(simulation))
    start = p.position.copy()
    ops.map_to_particles(dt)
    np.testing.assert_allclose(p.position[:, 0], start[:, 0] * (1 + rate * dt), rtol=1e-13)
    np.testing.assert_allclose(p.position[:, 1], start[:, 1], rtol=0, atol=1e-15)


@each_shape
@pytest.mark.parametrize("order", REGISTRY.of_kind("order"))
def test_particles_that_expand_uniformly_are_seen_so_inside(shape, order):
    """v_r = e r, v_z = -2 e z at the particles: D_rr = D_θθ inside the body, to the error of the mapping."""
    simulation = scene(shape, {"kind": "box", "lower": [0.0, -0.4], "upper": [0.8, 0.4]}, order=order)
    p = simulation.particles
    rate = 0.1
    p.velocity[:, 0] = rate * p.position[:, 0]
    p.velocity[:, 1] = -2 * rate * (p.position[:, 1] + simulation.grid.lower[1])
    simulation.advance()
    z = p.position[:, 1] + simulation.grid.lower[1]
    inside = (p.position[:, 0] > DX) & (p.position[:, 0] < 0.7) & (np.abs(z) < 0.3)
    L = p.velocity_gradient[inside]
    # The mean radius of what a node is given is not its own radius: a relative error of order (dx/r)².
    tolerance = 0.5 * rate * (DX / p.position[inside, 0]) ** 2 + 1e-3 * rate
    assert (np.abs(L[:, 0, 0] - rate) < tolerance).all()
    assert (np.abs(L[:, 2, 2] - rate) < tolerance).all()
    assert np.abs(L[:, 1, 1] + 2 * rate).max() < 1e-3 * rate


@each_shape
@pytest.mark.parametrize("order", REGISTRY.of_kind("order"))
def test_ball_in_free_fall_stays_a_ball(validate, shape, order):
    simulation = scene(shape, BALL, order=order, gravity=[0.0, -9.81])
    p = simulation.particles
    start = p.position[np.argsort(p.number)].copy()
    while simulation.time < 0.3:
        simulation.advance(at_most=0.3 - simulation.time)
    moved = p.position[np.argsort(p.number)] - start
    off = max(np.abs(moved[:, 0]).max(), np.abs(moved[:, 1] - moved[0, 1]).max())
    validate("Ball in free fall, axisymmetric: change of its shape", off, below(1e-12, "0"), unit="m")
    assert moved[0, 1] == pytest.approx(-9.81 * 0.3**2 / 2, rel=0.02)
    np.testing.assert_allclose(p.velocity[:, 1], -9.81 * 0.3, rtol=1e-12)


@pytest.mark.parametrize(
    ("body", "volume"),
    [
        (CYLINDER, math.pi * 0.4**2 * 0.4),
        ({"kind": "box", "lower": [0.3, 0.0], "upper": [0.5, 0.2]}, math.pi * (0.25 - 0.09) * 0.2),
        (BALL, 4 / 3 * math.pi * 0.3**3),
    ],
    ids=["cylinder", "ring", "ball"],
)
def test_mass_is_that_of_the_full_circle(validate, body, volume):
    simulation = scene("cpgimp", body)
    p = simulation.particles
    off = abs(p.mass.sum() / (1000.0 * volume) - 1)
    validate("Axisymmetric cylinder, ring and ball: mass, relative error", off, below(1e-12, "0"))
    # Of a ring: 2 pi r times its cross-section; where a curved surface cuts it, that is counted by points.
    ratio = p.mass / (1000.0 * 2 * math.pi * p.position[:, 0] * 4 * p.half_size.prod(axis=1))
    whole = (p.half_size == DX / 4).all(axis=1)
    assert whole.mean() > 0.6
    assert ratio[whole] == pytest.approx(1.0, rel=1e-12 if body["kind"] == "box" else 5e-3)
    assert ratio[~whole] == pytest.approx(1.0, rel=0.02)


@each_shape
def test_nodal_force_of_a_uniform_pressure_vanishes_inside(validate, shape):
    """div (p I) = 0: hoop stress and radial stress balance at every node, on the axis too."""
    simulation = scene(shape, {"kind": "box", "lower": [0.0, -0.3], "upper": [0.6, 0.3]})
    ops, p = simulation.operations, simulation.particles
    p.stress[:, :3] = -1000.0
    ops.begin()
    ops.map_to_grid()
    window = ops.window
    force = window.nodes[:, 3:5].reshape(*window.shape[:2], 2)
    mass = window.nodes[:, 0].reshape(window.shape[:2])
    full = mass > 0
    i = np.arange(window.shape[0]) + window.lower[0]
    j = np.arange(window.shape[1]) + window.lower[1] - round(1.0 / DX)  # z = 0 is node 20
    inner = full & (i[:, None] >= 1) & (i[:, None] <= 10) & (np.abs(j)[None, :] <= 4)
    scale = 1000.0 * 2 * math.pi * 0.6 * DX  # of the force at a node of the surface
    assert inner.sum() > 50
    assert np.abs(force[inner][:, 1]).max() < 1e-9 * scale
    worst, bound = np.abs(force[inner][:, 0]).max() / scale, 1e-9 if shape != "linear" else 1e-2
    name = f"Axisymmetric, uniform pressure, {shape}: radial force on inner nodes, relative"
    validate(name, worst, below(bound, "0"))


def test_a_domain_that_does_not_begin_at_the_axis_is_refused():
    with pytest.raises(CaseError, match=r"grid\.domain\.r"):
        scene("cpgimp", CYLINDER, domain={"r": [0.1, 1.0], "z": [-1.0, 1.0]})


@pytest.mark.parametrize("order", REGISTRY.of_kind("order"))
def test_a_cylinder_breathes_with_its_own_period(validate, order):
    """First radial mode of a long elastic cylinder between planes of symmetry, plane strain.

    u = J1(k r) with k R J0(k R) = (1 - 2 nu)/(1 - nu) J1(k R): k R = 2.0488 at nu = 0.3 (1.8412 at nu = 0).
    """
    radius, nu = 0.4, 0.3
    kR = first_radial_mode(nu)
    c = math.sqrt(1e5 * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / 1000.0)
    period = 2 * math.pi * radius / (kR * c)
    case = mpmkit.parse_case(
        {
            "space": "axisymmetric",
            "until": 1.0,
            "gravity": [0.0, 0.0],
            "grid": {
                "cell_size": 0.02,
                "domain": {"r": [0.0, 0.5], "z": [0.0, 0.06]},
                "faces": {"z_min": "symmetry", "z_max": "symmetry"},
            },
            "bodies": [
                {"shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [radius, 0.06]}, "material": RUBBER}
            ],
            "scheme": {"order": order, "time_step": {"fraction": 0.1}},
        }
    )
    simulation = mpmkit.Simulation(case)
    p = simulation.particles
    p.velocity[:, 0] = 0.01 * p.position[:, 0] / radius
    signal, times = [], []
    while simulation.time < 3 * period:
        simulation.advance()
        signal.append(float(np.sum(p.mass * p.velocity[:, 0] * p.position[:, 0])))
        times.append(simulation.time)
    signal = np.array(signal)
    zeros = np.flatnonzero(np.sign(signal[:-1]) != np.sign(signal[1:]))
    found = 2 * (times[zeros[4]] - times[zeros[0]]) / 4
    name = f"Breathing elastic cylinder, {order.upper()}: period"
    validate(name, found, close_to(period, rel=0.02), unit="s")


def first_radial_mode(nu):
    """Smallest k R, by bisection with Bessel's series."""

    def J(n, x):
        return sum(
            (-1) ** m / (math.factorial(m) * math.factorial(m + n)) * (x / 2) ** (2 * m + n)
            for m in range(30)
        )

    def f(x):
        return x * J(0, x) - (1 - 2 * nu) / (1 - nu) * J(1, x)

    low, high = 1.0, 2.4
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if f(middle) > 0 else (low, middle)
    return low
