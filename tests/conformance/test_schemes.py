"""Shape functions, update orders and velocity updates together, in every space.

Mass and momentum are conserved to rounding. Results do not depend on the number of threads, nor on the
position of a body on the grid. A scene with mirrors or periodic faces has the result of the whole scene.
"""

from __future__ import annotations

from itertools import product

import numba
import numpy as np
import pytest
from pairwise import every_pair, pairwise

from mpmkit.registry import installed
from mpmkit.testing import flight, order_checks, scenes
from mpmkit.testing.scenes import DX, RUBBER, SMALL_STEP, SPACES, by_number, shake

REGISTRY = installed()
SCHEMES = pairwise(*(REGISTRY.of_kind(kind) for kind in ("shape", "order", "velocity")))
VELOCITIES = list(REGISTRY.of_kind("velocity"))
PAIRS = list(product(REGISTRY.of_kind("shape"), REGISTRY.of_kind("order")))
FEWER_SCHEMES = [(*pair, VELOCITIES[i % len(VELOCITIES)]) for i, pair in enumerate(PAIRS)]
"""Every shape function with every order, and every velocity update with some of them."""
SYRUP = {"law": "newtonian", "density": 1200.0, "viscosity": 5.0, "sound_speed": 10.0}
CONCRETE = {
    "law": "herschel-bulkley-evp",
    "density": 1200.0,
    "yield_stress": 20.0,
    "consistency": 5.0,
    "flow_index": 1.33,
    "sound_speed": 10.0,
}

FLIGHTS = [flight.momentum, flight.free_fall, flight.uniform_motion]

each_scheme = pytest.mark.parametrize("scheme", SCHEMES, ids="-".join)
each_space = pytest.mark.parametrize("space", SPACES)


@pytest.fixture(autouse=True)
def _one_thread():
    numba.set_num_threads(1)


def simulate(space, scheme, bodies, domain, faces=None, gravity=None, fraction=0.4, volumetric="own"):
    """A scene on cells of DX, of a shape, an order and a velocity update."""
    named = dict(zip(("shape", "order", "velocity"), scheme, strict=True), volumetric=volumetric)
    return scenes.simulate(space, named, bodies, domain, faces, gravity, fraction)


# --- Free flight --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{name}: {check.name}")
        for name, order in REGISTRY.of_kind("order").items()
        for check in order_checks(order())
    ],
)
def test_conformance(check):
    check()


@every_pair("check, space, scheme", FLIGHTS, SPACES, SCHEMES)
def test_free_flight(check, space, scheme):
    check(space, dict(zip(("shape", "order", "velocity"), scheme, strict=True), volumetric="own"))


# --- Threads ------------------------------------------------------------------------------------------------


def run_with_threads(threads, make, steps):
    numba.set_num_threads(threads)
    simulation = make()
    shake(simulation)
    for _ in range(steps):
        simulation.advance()
        load = np.diff(simulation.operations.sorting.tasks).sum(axis=0)
        assert ((load > 0).sum(axis=1) > 1).any()  # blocks of one colour, for two threads to meet in
    assert simulation.operations.sorting.sorts > 1  # the order of particles changed on the way
    return simulation.particles.arrays()


def assert_same_bits(make, steps=20):
    one, two = (run_with_threads(threads, make, steps) for threads in (1, 2))
    for name in one:
        np.testing.assert_array_equal(one[name], two[name], err_msg=name)


@pytest.mark.parametrize("scheme", FEWER_SCHEMES, ids="-".join)
@each_space
def test_thread_count_changes_no_bit(space, scheme):
    dim = 3 if space == "3d" else 2
    lower, upper = [3, 3, 3][:dim], [[16, 9], [17, 5, 6]][dim - 2]
    domain = [[0, 24], [0, 20], [0, 20]][:dim]
    velocity = [14.0, 6.0, 3.0][:dim]
    if space == "axisymmetric":
        lower[0], velocity = 0, [0.0, 14.0]
    bodies = [(lower, upper, RUBBER, velocity)]
    steps = 25 if space == "axisymmetric" else 20
    assert_same_bits(lambda: simulate(space, scheme, bodies, domain, fraction=SMALL_STEP), steps)


@pytest.mark.parametrize("volumetric", REGISTRY.of_kind("volumetric"))
@each_space
def test_thread_count_changes_no_bit_of_a_fluid(space, volumetric):
    dim = 3 if space == "3d" else 2
    lower, upper = [0, 0, 0][:dim], [[16, 9], [17, 5, 6]][dim - 2]
    domain = [[0, 30], [0, 14], [0, 14]][:dim]
    faces = {"plane-strain": {"x_min": "symmetry"}, "3d": {"x_min": "symmetry", "y_min": "slip"}}
    bodies = [(lower, upper, SYRUP, None)]
    gravity = [0.0] * (dim - 1) + [-9.81]

    def make():
        simulation = simulate(
            space,
            ("cpgimp", "usl", "flip"),
            bodies,
            domain,
            {"z_min": "stick", **faces.get(space, {})},
            gravity,
            volumetric=volumetric,
        )
        simulation.particles.velocity[:, 0] += 12.0 * simulation.particles.position[:, 0]
        return simulation

    assert_same_bits(make)


@each_space
@pytest.mark.parametrize("order", REGISTRY.of_kind("order"))
def test_thread_count_changes_no_bit_of_two_materials_with_all_there_is(space, order):
    """With affine velocities, averaged pressures, an exact yield stress, and a block of rubber beside the
    fluid."""
    dim = 3 if space == "3d" else 2
    lower, middle, upper = [0, 0, 0][:dim], [[9, 8], [9, 5, 4]][dim - 2], [[16, 8], [17, 5, 4]][dim - 2]
    bodies = [
        (lower, middle, CONCRETE, None),
        ([middle[0], *lower[1:]], upper, RUBBER, None),
    ]
    domain = [[0, 30], [0, 14], [0, 14]][:dim]
    faces = {} if space == "axisymmetric" else {"x_min": "symmetry"}
    faces["z_min"] = {"kind": "friction", "coefficient": 0.3}
    gravity = [0.0] * (dim - 1) + [-9.81]

    def make():
        scheme = ("cpgimp", order, "apic")
        simulation = simulate(space, scheme, bodies, domain, faces, gravity, 0.2, "nodal-average")
        simulation.particles.velocity[:, 0] += 12.0 * simulation.particles.position[:, 0]
        return simulation

    assert_same_bits(make)


# --- Mirrors ------------------------------------------------------------------------------------------------


@each_scheme
@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_symmetry_planes_stand_for_the_other_half(space, scheme):
    """A falling, spreading block on a slip floor: a half (2-D) or a quarter (3-D) is the full model, cut."""
    dim = 3 if space == "3d" else 2
    gravity = [0.0] * (dim - 1) + [-9.81]
    faces = {"z_min": "slip"}
    body = ([-2] * (dim - 1) + [0], [2] * (dim - 1) + [4], RUBBER, None)
    whole = simulate(space, scheme, [body], [[-5, 5]] * (dim - 1) + [[0, 7]], faces, gravity)
    cuts = {"x_min": "symmetry", "y_min": "symmetry"} if dim == 3 else {"x_min": "symmetry"}
    part = simulate(space, scheme, [body], [[0, 5]] * (dim - 1) + [[0, 7]], {**faces, **cuts}, gravity)
    for simulation in (whole, part):
        p = simulation.particles
        x = p.position + simulation.grid.lower
        p.velocity[:, :-1] = 3.0 * np.sin(2.0 * x[:, :-1])
        p.velocity[:, -1] = -(x[:, -1] ** 2)
    kept = np.all(by_number(whole)[:, :-1] + whole.grid.lower[:-1] > 0, axis=1)
    assert kept.sum() == len(part.particles)
    for _ in range(20):
        whole.advance()
        part.advance()
    assert whole.time == pytest.approx(part.time, rel=1e-12)
    np.testing.assert_allclose(
        by_number(whole)[kept] + whole.grid.lower, by_number(part) + part.grid.lower, rtol=0, atol=1e-9 * DX
    )
    for field, scale in (("velocity", 1.0), ("stress", RUBBER["youngs_modulus"]), ("volume_ratio", 1.0)):
        found, expected = by_number(part, field), by_number(whole, field)[kept]
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * scale, err_msg=field)


@each_scheme
def test_a_plane_of_symmetry_stands_for_the_mirrored_body(scheme):
    """A block thrown at a plane of symmetry moves like one that meets its mirror image."""
    body = ([3, 0], [7, 4], RUBBER, [0.0, -1.0])
    image = ([3, -4], [7, 0], RUBBER, [0.0, 1.0])
    floor = simulate("plane-strain", scheme, [body], [[0, 10], [0, 8]], {"z_min": "symmetry"})
    twins = simulate("plane-strain", scheme, [body, image], [[0, 10], [-8, 8]])
    for _ in range(25):
        floor.advance()
        twins.advance()
    upper = by_number(twins, "body") == 0
    assert np.abs(by_number(floor, "stress")).max() > 1.0
    np.testing.assert_allclose(
        by_number(floor), (by_number(twins) + twins.grid.lower)[upper], rtol=0, atol=1e-9 * DX
    )
    np.testing.assert_allclose(
        by_number(floor, "velocity"), by_number(twins, "velocity")[upper], rtol=0, atol=1e-9
    )


# --- Where on the grid --------------------------------------------------------------------------------------


@every_pair("scheme, axis, direction", SCHEMES, [0, 1], [1, -1])
def test_window_follows_a_fast_body(scheme, axis, direction):
    """A small body crosses many blocks of a large domain, and all of its mass stays on stored nodes."""
    lower, upper = [100, 100], [101, 102]
    velocity = [0.0, 0.0]
    velocity[axis] = 60.0 * direction
    simulation = simulate("plane-strain", scheme, [(lower, upper, RUBBER, velocity)], [[0, 200], [0, 200]])
    mass = simulation.particles.mass.sum()
    start = by_number(simulation).copy()
    while np.ptp([start.mean(axis=0)[axis], simulation.particles.position.mean(axis=0)[axis]]) < 60 * DX:
        simulation.advance()
        window = simulation.operations.window
        base, last = simulation.operations.base, simulation.operations.weight.shape[2] - 1
        assert (base >= window.lower).all()
        assert (base + last < window.lower + window.shape[:2]).all()
        assert window.nodes[:, 0].sum() == pytest.approx(mass, rel=1e-13)
        assert len(window.nodes) < 400  # of 41,000
    shift = simulation.time * np.array(velocity)
    np.testing.assert_allclose(by_number(simulation), start + shift, rtol=0, atol=1e-11)


@each_scheme
def test_motion_does_not_depend_on_the_place(scheme):
    """A deforming body moves in the same way 1000 cells further on."""
    far = 1003
    found = []
    for corner in (3, far):
        box = ([corner, corner], [corner + 6, corner + 4], RUBBER, [8.0, 6.0])
        simulation = simulate("plane-strain", scheme, [box], [[0, 2000], [0, 2000]], fraction=SMALL_STEP)
        shake(simulation)
        for _ in range(60):
            simulation.advance()
        found.append(by_number(simulation) - corner * DX)
    np.testing.assert_allclose(found[1], found[0], rtol=0, atol=1e-9 * DX)


@every_pair("scheme, axis, direction", SCHEMES, [0, 1], [1, -1])
def test_periodic_faces_wrap_the_unwrapped_motion(scheme, axis, direction):
    period = 8
    velocity = [0.0, 0.0]
    velocity[axis] = 20.0 * direction
    name = "xz"[axis]
    lower, upper = [20, 20], [24, 23]
    unwrapped = simulate("plane-strain", scheme, [(lower, upper, RUBBER, velocity)], [[-12, 56], [-12, 56]])
    domain = [[12, 32], [12, 32]]
    domain[axis] = [18, 18 + period]
    faces = {f"{name}_min": "periodic", f"{name}_max": "periodic"}
    wrapped = simulate("plane-strain", scheme, [(lower, upper, RUBBER, velocity)], domain, faces)
    for simulation in (unwrapped, wrapped):
        shake(simulation)
        for _ in range(60):
            simulation.advance()
    moved = by_number(unwrapped) + unwrapped.grid.lower - by_number(wrapped) - wrapped.grid.lower
    turns = moved[:, axis] / (period * DX)
    assert np.abs(turns).max() >= 1  # it did go round
    np.testing.assert_allclose(turns, np.rint(turns), rtol=0, atol=1e-9)
    np.testing.assert_allclose(moved[:, 1 - axis], 0.0, rtol=0, atol=1e-9 * DX)
    for field, scale in (("velocity", 20.0), ("stress", RUBBER["youngs_modulus"])):
        np.testing.assert_allclose(
            by_number(wrapped, field), by_number(unwrapped, field), rtol=0, atol=1e-9 * scale, err_msg=field
        )


@each_scheme
def test_a_body_that_fills_a_period_has_no_ends(scheme):
    """A uniform bar between periodic faces moves through itself without any stress."""
    faces = {"x_min": "periodic", "x_max": "periodic"}
    body = ([0, 3], [6, 5], RUBBER, [5.0, 0.0])
    simulation = simulate("plane-strain", scheme, [body], [[0, 6], [0, 8]], faces)
    for _ in range(60):
        simulation.advance()
    assert np.abs(simulation.particles.stress).max() < 1e-9 * RUBBER["youngs_modulus"]
    np.testing.assert_allclose(
        simulation.particles.velocity, [[5.0, 0.0]] * len(simulation.particles), atol=1e-12
    )


# --- Several materials --------------------------------------------------------------------------------------


@each_scheme
@each_space
def test_two_materials_meet(space, scheme):
    """A drop and a rubber block collide: each keeps its own law and mass, their momentum adds up."""
    dim = 3 if space == "3d" else 2
    side = [0 if space == "axisymmetric" else 3] * (dim - 1)
    across = [3 if space == "axisymmetric" else 6] * (dim - 1)
    drop = ([*side, 7], [*across, 10], SYRUP, [0.0] * (dim - 1) + [-3.0])
    rubber = ([*side, 4], [*across, 7], RUBBER, [0.0] * (dim - 1) + [3.0])
    domain = [[0, 9]] * (dim - 1) + [[0, 14]]
    simulation = simulate(space, scheme, [drop, rubber], domain, fraction=SMALL_STEP / 2)
    p = simulation.particles
    names = by_number(simulation, "body").copy()
    momentum = (p.mass @ p.velocity)[-1]
    scale = float(np.sum(p.mass * np.abs(p.velocity[:, -1])))
    for _ in range(60):
        simulation.advance()
        simulation.check()
    assert (p.mass @ p.velocity)[-1] == pytest.approx(momentum, abs=1e-12 * scale)
    np.testing.assert_array_equal(by_number(simulation, "body"), names)
    density = np.array([SYRUP["density"], RUBBER["density"]])[p.body]
    assert p.mass / p.initial_volume == pytest.approx(density, rel=1e-12)
    for group in p.groups:
        assert (density[group.part] == group.density).all()
    drops, solid = p.body == 0, p.body == 1
    assert (p.pressure[solid] == 0).all()  # the law of rubber has a stress of its own
    assert p.pressure[drops].max() > 0.0
    # The collision slows both down: what the drop loses the block takes up.
    assert p.velocity[drops, -1].mean() > -2.95
    assert p.velocity[solid, -1].mean() < 2.95
