"""Faces of the domain: slip, stick, Coulomb friction, periodic and open, each by what a body does at it."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

import mpmkit
from mpmkit.errors import GuardStop
from mpmkit.registry import installed

DX, G = 0.05, 9.81
STIFF = {"law": "neo-hookean", "density": 1000.0, "youngs_modulus": 1e6, "poisson_ratio": 0.3}
SOFT = {"law": "neo-hookean", "density": 1000.0, "youngs_modulus": 1e5, "poisson_ratio": 0.3}
SHAPES = list(installed().of_kind("shape"))
ORDERS = list(installed().of_kind("order"))


@pytest.fixture(autouse=True)
def _one_thread():
    numba.set_num_threads(1)


def scene(
    lower, upper, domain, faces, gravity=(0.0, 0.0), velocity=(0.0, 0.0), material=STIFF, shape="cpgimp",
    order="musl", update="flip", fraction=0.4,
):  # fmt: skip
    """A block in plane strain; lengths in cells."""
    axes = "xyz" if len(lower) == 3 else "xz"
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "3d" if len(lower) == 3 else "plane-strain",
                "until": 1.0,
                "gravity": list(gravity),
                "grid": {
                    "cell_size": DX,
                    "domain": {a: [low * DX, high * DX] for a, (low, high) in zip(axes, domain, strict=True)},
                    "faces": faces,
                },
                "bodies": [
                    {
                        "shape": {
                            "kind": "box",
                            "lower": [DX * x for x in lower],
                            "upper": [DX * x for x in upper],
                        },
                        "material": material,
                        "velocity": list(velocity),
                    }
                ],
                "scheme": {
                    "shape": shape,
                    "order": order,
                    "velocity": update,
                    "time_step": {"fraction": fraction},
                },
            }
        )
    )


def mean_velocity(simulation):
    p = simulation.particles
    return p.mass @ p.velocity / p.mass.sum()


def mean_position(simulation):
    p = simulation.particles
    return p.mass @ p.position / p.mass.sum()


def rub(coefficient):
    return {"kind": "friction", "coefficient": coefficient}


# --- Slip ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("order", ["usf", "musl"])
def test_slip_floor_takes_no_tangential_momentum(shape, order):
    """A block that slides under gravity keeps its speed along the floor exactly and does not sink."""
    simulation = scene(
        [2, 0], [6, 4], [[0, 40], [0, 8]], {"z_min": "slip"}, (0, -G), (1.0, 0), STIFF, shape, order
    )
    p = simulation.particles
    while simulation.time < 0.5:
        simulation.advance()
        assert p.position[:, 1].min() > 0
    assert mean_velocity(simulation)[0] == pytest.approx(1.0, rel=1e-11)
    assert mean_position(simulation)[1] == pytest.approx(2 * DX, abs=0.01 * DX)


@pytest.mark.parametrize("face", ["x_min", "x_max", "z_min", "z_max"])
@pytest.mark.parametrize("kind", ["slip", "symmetry", "stick", rub(0.3)], ids=str)
def test_block_bounces_off_every_face(face, kind):
    """Thrown straight at a wall, it comes back with most of its momentum, and alike from the four of them."""
    axis, sign = "xz".index(face[0]), -1.0 if face.endswith("min") else 1.0
    velocity = [0.0, 0.0]
    velocity[axis] = sign
    simulation = scene([4, 4], [8, 8], [[0, 12], [0, 12]], {face: kind}, velocity=velocity, material=SOFT)
    while simulation.time < 0.5:
        simulation.advance()
    back = mean_velocity(simulation)
    assert -1.0 < sign * back[axis] < -0.6
    assert abs(back[1 - axis]) < 1e-9
    reference = scene([4, 4], [8, 8], [[0, 12], [0, 12]], {"z_min": kind}, velocity=[0, -1.0], material=SOFT)
    while reference.time < 0.5:
        reference.advance()
    assert sign * back[axis] == pytest.approx(-mean_velocity(reference)[1], rel=1e-6)


# --- Stick --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", SHAPES)
def test_layer_hangs_on_a_stick_floor(shape):
    """An elastic layer, periodic along x, under a pull along x: u = (rho g / G)(H z - z²/2), tau = rho g (H - z)."""
    cells, pull = 10, 0.5
    height, modulus = cells * DX, 1e5 / 2.6
    faces = {"x_min": "periodic", "x_max": "periodic", "z_min": "stick"}
    simulation = scene(
        [0, 0], [3, cells], [[0, 3], [0, cells + 2]], faces, (pull, 0.0), material=SOFT, shape=shape,
        update={"name": "blend", "rate": 200.0},
    )  # fmt: skip
    p = simulation.particles
    start = p.position[np.argsort(p.number)].copy()
    period = 4 * height / math.sqrt(modulus / 1000.0)
    # Damped by hand: the layer's own velocity is taken off at the rate of critical damping.
    while simulation.time < 3 * period:
        dt = simulation.advance()
        p.velocity *= math.exp(-4 * math.pi / period * dt)
    order = np.argsort(p.number)
    z = start[:, 1]
    moved = p.position[order, 0] - start[:, 0]
    moved -= 3 * DX * np.rint(moved / (3 * DX))
    exact = 1000.0 * pull / modulus * (height * z - z**2 / 2)
    assert np.abs(moved - exact).max() < 0.02 * exact.max()
    shear = p.stress[order, 4]
    assert np.abs(shear - 1000.0 * pull * (height - z)).max() < 0.04 * 1000.0 * pull * height


@pytest.mark.parametrize("kind", ["stick", "slip", rub(0.5)], ids=str)
def test_nodes_of_a_wall_obey_it(kind):
    simulation = scene([2, 0], [6, 4], [[0, 12], [0, 8]], {"z_min": kind}, (2.0, -G), (1.0, -0.5), SOFT)
    for _ in range(50):
        simulation.advance()
        window = simulation.operations.window
        nodes = window.nodes.reshape(*window.shape[:2], -1)
        floor = nodes[:, window.walls[1, 0]]
        heavy = floor[:, 0] > 0
        assert (floor[heavy, 2] >= -1e-15).all()  # nothing moves into the wall
        if kind == "stick":
            assert (floor[:, 1:3] == 0).all()
        elif kind == "slip":
            assert (floor[:, 2] == 0).all()
            assert np.abs(floor[heavy, 1]).max() > 0.5


# --- Friction -----------------------------------------------------------------------------------------------


def slide(angle, coefficient, shape="cpgimp", order="musl", until=0.6, space=2):
    """Mean acceleration along the incline of a stiff block that starts at rest, and how far it came."""
    gravity = [G * math.sin(angle), -G * math.cos(angle)]
    lower, upper, domain = [2, 0], [8, 3], [[0, 60], [0, 7]]
    if space == 3:
        gravity.insert(1, 0.0)
        lower, upper, domain = [2, 2, 0], [6, 4, 2], [[0, 60], [0, 6], [0, 6]]
    simulation = scene(
        lower, upper, domain, {"z_min": rub(coefficient)}, gravity, [0.0] * len(lower), STIFF, shape, order,
        {"name": "blend", "rate": 20.0},
    )  # fmt: skip
    start = mean_position(simulation)[0]
    times, speeds = [], []
    while simulation.time < until:
        simulation.advance()
        times.append(simulation.time)
        speeds.append(mean_velocity(simulation)[0])
    late = np.array(times) > until / 3  # the block has settled under its weight
    slope = np.polyfit(np.array(times)[late], np.array(speeds)[late], 1)[0]
    return slope, mean_position(simulation)[0] - start


SLIDING = [(30, 0.3), (30, 0.0), (45, 0.5), (20, 0.2)]


@pytest.mark.parametrize(("degrees", "coefficient"), SLIDING)
@pytest.mark.parametrize("shape", SHAPES)
def test_block_slides_down_an_incline(shape, degrees, coefficient):
    """a = g (sin θ - µ cos θ) where tan θ > µ."""
    angle = math.radians(degrees)
    exact = G * (math.sin(angle) - coefficient * math.cos(angle))
    found, _ = slide(angle, coefficient, shape)
    assert found == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize("order", ORDERS)
def test_block_slides_in_every_order(order):
    angle = math.radians(30)
    found, _ = slide(angle, 0.3, order=order, until=0.3)
    assert found == pytest.approx(G * (math.sin(angle) - 0.3 * math.cos(angle)), rel=0.03)


@pytest.mark.parametrize(("degrees", "coefficient"), [(30, 0.7), (20, 0.5), (10, 0.3)])
@pytest.mark.parametrize("shape", SHAPES)
def test_block_sticks_on_an_incline(shape, degrees, coefficient):
    """Where tan θ < µ it stays: no acceleration, and no creep beyond the elastic lean of the block."""
    angle = math.radians(degrees)
    found, moved = slide(angle, coefficient, shape)
    assert abs(found) < 0.005 * G
    fallen = G * math.sin(angle) * 0.6**2 / 2
    assert 0 <= moved < 0.005 * fallen


def test_block_slides_in_three_dimensions():
    angle = math.radians(30)
    found, _ = slide(angle, 0.3, until=0.3, space=3)
    assert found == pytest.approx(G * (math.sin(angle) - 0.3 * math.cos(angle)), rel=0.03)


def test_friction_wall_does_not_pull():
    """A block that is lifted off leaves the wall as it leaves no wall at all."""
    free = scene([2, 1], [6, 5], [[0, 12], [0, 30]], {}, (0.0, 2.0), (0.0, 0.5))
    wall = scene([2, 0], [6, 4], [[0, 12], [0, 30]], {"z_min": rub(0.5)}, (0.0, 2.0), (0.0, 0.5))
    for _ in range(100):
        free.advance()
        wall.advance()
    np.testing.assert_allclose(wall.particles.velocity, free.particles.velocity, rtol=0, atol=1e-10)


# --- Periodic and open --------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("order", ORDERS)
def test_periodic_face_lets_a_body_through_unchanged(shape, order):
    faces = {f"{axis}_{side}": "periodic" for axis in "xz" for side in ("min", "max")}
    simulation = scene(
        [3, 3], [6, 6], [[0, 8], [0, 8]], faces, velocity=(2.0, -1.5), shape=shape, order=order
    )
    p = simulation.particles
    start = p.position[np.argsort(p.number)].copy()
    while simulation.time < 1.0:
        simulation.advance(at_most=1.0 - simulation.time)
    np.testing.assert_allclose(p.velocity, np.tile([2.0, -1.5], (len(p), 1)), rtol=0, atol=1e-10)
    back = p.position[np.argsort(p.number)] - start - [2.0, -1.5]
    np.testing.assert_allclose(back - 8 * DX * np.rint(back / (8 * DX)), 0.0, rtol=0, atol=1e-10)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("axis", "direction"), [(0, -1), (0, 1), (1, -1), (1, 1)])
def test_open_face_does_nothing_until_the_body_leaves(shape, axis, direction):
    velocity = [0.0, 0.0]
    velocity[axis] = 2.0 * direction
    simulation = scene([4, 4], [8, 8], [[0, 12], [0, 12]], {}, velocity=velocity, shape=shape)
    with pytest.raises(GuardStop, match="left the grid") as stopped:
        while simulation.time < 1.0:
            simulation.advance()
            deviation = simulation.particles.velocity - velocity
            assert np.abs(deviation).max() < 1e-10
    assert stopped.value.reason == "particle-outside"
    assert simulation.time == pytest.approx((4 + 0.25) * DX / 2.0, rel=0.05)
