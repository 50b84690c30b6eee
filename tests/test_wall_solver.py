"""Walls in the solver: what they do to nodes and particles, to the bit where it is exact."""

from __future__ import annotations

import copy
import math

import numba
import numpy as np
import pytest
import xarray

import mpmkit
from mpmkit.errors import CaseError
from mpmkit.kernels import ghosts, wall_contact, wall_reach
from mpmkit.solver.simulation import Simulation

CELL = 0.05
FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 5.0, "sound_speed": 15.0}
CONCRETE = {
    "law": "bingham-evp",
    "density": 2000.0,
    "yield_stress": 50.0,
    "plastic_viscosity": 20.0,
    "sound_speed": 15.0,
}


def wall(point, normal, contact="slip", **more):
    return {"surface": {"kind": "plane", "point": point, "normal": normal, **more}, "contact": contact}


def scene(walls, material=FLUID, velocity=(0.0, 0.0), lower=(0.2, 0.2), upper=(0.5, 0.4), faces=None, **more):
    """A block in plane strain."""
    case = {
        "space": "plane-strain",
        "until": 1.0,
        "grid": {
            "cell_size": CELL,
            "domain": {"x": [-0.5, 1.0], "z": [-0.5, 1.0]},
            "faces": faces or {},
        },
        "walls": walls,
        "bodies": [
            {
                "shape": {"kind": "box", "lower": list(lower), "upper": list(upper)},
                "material": material,
                "velocity": list(velocity),
            }
        ],
    }
    return copy.deepcopy(case | more)


def simulated(*arguments, **more):
    return Simulation(mpmkit.parse_case(scene(*arguments, **more)))


def advance(simulation, steps):
    for _ in range(steps):
        simulation.advance()
    return simulation


UP = {"kind": "velocity", "velocity": [0.1, 0.4]}
SLOPE = wall([0.2, 0.16], [-0.1, 1.0], {"kind": "coulomb", "coefficient": 0.3}, motion=UP)


# --- The same bits ------------------------------------------------------------------------------------------


def assert_same(a, b):
    left, right = a.state(), b.state()
    assert left.keys() == right.keys()
    for name, array in left.items():
        np.testing.assert_array_equal(array, right[name], err_msg=name)


@pytest.mark.parametrize("contact", ["slip", "stick", {"kind": "coulomb", "coefficient": 0.3}], ids=str)
def test_same_bits_with_any_number_of_threads(contact):
    found = []
    for threads in (1, 2):
        numba.set_num_threads(threads)
        found.append(advance(simulated({"slope": {**SLOPE, "contact": contact}}, CONCRETE), 60))
    assert_same(*found)
    assert found[0].wall_sums().any()


@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
@pytest.mark.parametrize("stop", [17, 40, 63])
def test_same_bits_after_a_stop(order, stop):
    """The wall moves by several cells, and is looked for anew in between."""
    fast = {**SLOPE, "surface": {**SLOPE["surface"], "motion": {"kind": "velocity", "velocity": [0, 2.0]}}}
    data = scene({"slope": fast}, CONCRETE, scheme={"order": order})
    whole = advance(Simulation(mpmkit.parse_case(data)), stop)
    again = Simulation(mpmkit.parse_case(data))
    again.restore({name: array.copy() for name, array in whole.state().items()})
    assert_same(again, whole)
    advance(again, 45)
    assert_same(again, advance(whole, 45))
    assert whole.time * 2.0 > 1.5 * CELL


# --- A wall that comes and goes -----------------------------------------------------------------------------


def floor(**more):
    return wall([0.0, 0.19], [0.0, 1.0], "slip", **more)


def impulses(walls, until, **more):
    """Time, s, and the vertical impulse of the wall so far, N s, step by step."""
    simulation = simulated(walls, **more)
    rows = []
    while simulation.time < until:
        simulation.advance()
        rows.append((simulation.time, simulation.wall_sums()[0, 1]))
    return simulation, np.array(rows)


def test_a_wall_that_vanishes_pushes_no_more():
    simulation, rows = impulses({"floor": floor(vanishes=0.12)}, 0.2)
    time, impulse = rows.T
    gone = time > 0.12 + 2 * simulation.time_step
    assert impulse[~gone].max() > 0
    assert np.ptp(impulse[gone]) == 0.0
    p, left = simulation.particles, 0.2 - 0.12
    assert p.position[:, 1].min() + simulation.grid.lower[1] < 0.19 - 0.4 * 9.81 * left**2 / 2  # it falls


def test_a_wall_that_appears_pushes_from_then_on():
    """What it finds behind its surface is put to it."""
    simulation, rows = impulses({"floor": floor(appears=0.06)}, 0.2)
    time, impulse = rows.T
    there = time > 0.06 + simulation.time_step
    assert not impulse[time < 0.06].any()
    assert impulse[there].max() > 0
    assert simulation.particles.position[:, 1].min() + simulation.grid.lower[1] > 0.19 - 0.1 * CELL


# --- A wall on the nodes ------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
@pytest.mark.parametrize(
    ("contact", "face", "rounding"),
    [
        ("stick", "stick", 1e-7),
        ("slip", {"kind": "friction", "coefficient": 0.0}, 1e-7),  # a face with slip holds what would leave
        ({"kind": "coulomb", "coefficient": 0.3}, {"kind": "friction", "coefficient": 0.3}, 2e-3),
    ],
    ids=["stick", "slip", "coulomb"],
)
def test_a_plane_on_the_nodes_is_a_face(contact, face, rounding, order):
    """A column sags and slides alike on both: to rounding, which nodes with next to no mass magnify.

    Only the drag of a wall counts what is mirrored beyond it: the face of the grid does not.
    """
    alike = {"gravity": [3.0, -9.81], "scheme": {"order": order, "redistribution": "none"}}
    as_wall = simulated({"floor": wall([0.0, 0.2], [0.0, 1.0], contact)}, **alike)
    grid = {"cell_size": CELL, "domain": {"x": [-0.5, 1.0], "z": [0.2, 1.0]}, "faces": {"z_min": face}}
    as_face = simulated({}, **alike, grid=grid)
    for _ in range(60):
        as_face.advance()
        as_wall.advance(as_face.time - as_wall.time)
    assert as_wall.time == pytest.approx(as_face.time, rel=1e-12)
    a, b = as_wall.particles, as_face.particles
    rows = np.argsort(a.number), np.argsort(b.number)
    fastest = np.abs(b.velocity).max()
    np.testing.assert_allclose(a.velocity[rows[0]], b.velocity[rows[1]], rtol=0, atol=rounding * fastest)
    places = [
        s.particles.position[row] + s.grid.lower for s, row in zip((as_wall, as_face), rows, strict=True)
    ]
    np.testing.assert_allclose(*places, rtol=0, atol=rounding * CELL)


def test_contact_is_held_until_it_is_decided_anew():
    """A node in contact keeps the normal velocity of the wall, though it would leave; no sweep frees it."""
    simulation = simulated({"floor": wall([0.0, 0.2], [0.0, 1.0], "slip")}, scheme={"order": "usl"})
    advance(simulation, 2)
    one = simulation.operations.walls.walls[0]
    near, nodes = one.near, simulation.operations.window.nodes
    held = near.at[near.at_wall][near.memory["contact"][near.at[near.at_wall]] == 1]
    assert len(held) > 4
    nodes[held, 2] = 0.3
    one.act(False, None)
    for turn in range(3):
        one.sweep(turn % 2 == 0, False)
    np.testing.assert_allclose(nodes[held, 2], 0.0, atol=1e-15)


@pytest.mark.parametrize("contact", ["slip", "stick", {"kind": "coulomb", "coefficient": 0.3}], ids=str)
@pytest.mark.parametrize(("point", "normal"), [([0, -0.02, 0], [0.1, 1, 0.15]), ([0, 0, 0.05], [1, 0, 0.6])])
def test_a_splash_where_a_leaning_wall_meets_a_floor_is_no_faster_than_its_fall(point, normal, contact):
    """What falls at 1.8 m/s on a slip floor beside the wall spreads at about twice that at most.

    Where a face holds a node, those around its image have a small part in the velocity at the wall. The sum
    was once brought right by them alone, and one of a part of 1e-9 became 1e9 times as fast.
    """
    domain = {"x": [-0.5, 0.6], "y": [-0.5, 0.6], "z": [0, 0.6]}
    simulation = Simulation(
        mpmkit.parse_case(
            {
                "space": "3d",
                "until": 1.0,
                "grid": {"cell_size": CELL, "domain": domain, "faces": {"z_min": "slip"}},
                "walls": {"w": wall(point, normal, contact)},
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0, 0, 0.1], "upper": [0.2, 0.2, 0.3]},
                        "material": FLUID,
                        "velocity": [0.2, 0.1, -1.0],
                    }
                ],
            }
        )
    )
    for _ in range(110):
        simulation.advance()
        assert np.abs(simulation.particles.velocity).max() < 3.8


@pytest.mark.parametrize("space", ["axisymmetric", "3d"])
def test_a_mould_that_stands_on_a_floor_holds_what_is_in_it(space):
    """Its rim is against the floor: a node there is behind its side, and nothing flows under it."""
    cell = 0.02
    radial = space == "axisymmetric"
    domain = {"r": [0, 0.2]} if radial else {"x": [0, 0.2], "y": [0, 0.2]}
    faces = {"z_min": "slip"} | ({} if radial else {"x_min": "symmetry", "y_min": "symmetry"})
    cone = {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.06, "height": 0.16}
    simulation = Simulation(
        mpmkit.parse_case(
            {
                "space": space,
                "until": 1.0,
                "grid": {"cell_size": cell, "domain": {**domain, "z": [0, 0.2]}, "faces": faces},
                "walls": {
                    "mould": {
                        "surface": {"kind": "body", "shape": cone, "side": "inside", "thickness": 0.03},
                        "contact": "slip",
                    }
                },
                "bodies": [{"shape": cone, "material": CONCRETE}],
            }
        )
    )
    while simulation.time < 0.2:
        simulation.advance()
    place = simulation.particles.position + simulation.grid.lower
    radius = place[:, 0] if radial else np.hypot(place[:, 0], place[:, 1])
    assert radius.max() < 0.1
    assert place[:, -1].max() > 0.16 - cell


@pytest.mark.parametrize("offset", [0.37, 0.8])
def test_drag_is_the_coefficient_times_the_push(offset):
    """Of a block that slides: what is mirrored beyond the wall pushes, and pulls, as well."""
    z = 0.1 + offset * CELL
    simulation = simulated(
        {"floor": wall([0.0, z], [0.0, 1.0], {"kind": "coulomb", "coefficient": 0.2})},
        material={"law": "neo-hookean", "density": 1000.0, "youngs_modulus": 1e6, "poisson_ratio": 0.3},
        lower=(0.2, z + 0.002),
        upper=(0.7, z + 0.202),
        velocity=(0.9, 0.0),
    )
    while simulation.time < 0.25:
        simulation.advance()
    drag, push = simulation.wall_sums()[0, :2]
    assert push == pytest.approx(simulation.particles.mass.sum() * 9.81 * simulation.time, rel=0.05)
    assert -drag / push == pytest.approx(0.2, rel=0.02)


# --- Kernels ------------------------------------------------------------------------------------------------


def laid(contact="stick", degrees=25.0, space="plane-strain"):
    """A wall in the middle of particles, which has yet to appear: nodes at it, ghosts, and their images."""
    normal = [-math.sin(math.radians(degrees)), math.cos(math.radians(degrees))]
    data = scene({"wall": wall([0.3, 0.3], normal, contact, appears=0.5)}, lower=(0.0, 0.0), upper=(0.6, 0.6))
    if space == "3d":
        data |= {"space": "3d"}
        data["grid"]["domain"] = {a: [-0.2, 0.5] for a in "xyz"}
        data["walls"]["wall"]["surface"] |= {"point": [0.12, 0.12, 0.21], "normal": [-0.2, 0.3, 1.0]}
        data["bodies"][0]["shape"] |= {"lower": [0.0, 0.0, 0.1], "upper": [0.25, 0.25, 0.35]}
        data["bodies"][0]["velocity"] = [0, 0, 0]
    simulation = advance(Simulation(mpmkit.parse_case(data)), 1)
    return simulation, simulation.operations.walls.walls[0].near


@pytest.mark.parametrize("odd", [False, True])
@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_fold_and_fill_are_transposes(odd, space):
    """Σ fold(a)·b = Σ a·fill(b) of momenta a and velocities b at any nodes, with a wall at rest."""
    simulation, near = laid(space=space)
    dim, random = simulation.grid.dim, np.random.default_rng(3)
    count = len(near.active)
    near.touched[:] = 1
    rest = np.zeros((len(near.at), dim))
    a = np.zeros((count, 1 + 2 * dim))
    a[:, 0], a[:, 1:] = random.random(count), random.standard_normal((count, 2 * dim))
    b = np.zeros((count, 1 + 2 * dim))
    b[:, 1:] = random.standard_normal((count, 2 * dim))
    folded, filled = a.copy(), b.copy()
    where = (near.ghosts, near.at, near.normal, rest, near.index, near.weight, near.touched, odd)
    ghosts.fold(folded, *where, True, True, near.held)
    ghosts.fill(filled, *where, True, 0.1, near.held, near.impulse, near.mapped)
    usable = near.ghosts[near.weight[near.ghosts, 0] >= 0]
    assert len(usable) > 4
    assert not folded[near.at[usable]].any()
    assert folded[:, 0].sum() == pytest.approx(a[:, 0].sum(), rel=1e-13)  # no mass is lost
    for part in (slice(1, 1 + dim), slice(1 + dim, None)):  # momentum with velocity, force with its change
        assert (folded[:, part] * b[:, part]).sum() == pytest.approx(
            (a[:, part] * filled[:, part]).sum(), rel=1e-12, abs=1e-11
        )


@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize("degrees", [0.0, 25.0, 45.0])
def test_push_adds_no_kinetic_energy(whole, degrees):
    """Of nodes against a wall at rest, whatever they do, however many sweeps there are."""
    simulation, near = laid(degrees=degrees)
    dim, random = simulation.grid.dim, np.random.default_rng(5)
    count = len(near.active)
    for sweeps in (0, 1, 3, 30):
        for _ in range(20):
            nodes = np.zeros((count, 1 + 2 * dim))
            nodes[:, 0] = np.where(near.active, random.random(count), 0.0)
            nodes[:, 1 : 1 + dim] = random.standard_normal((count, dim))
            before = (nodes[:, :1] * nodes[:, 1 : 1 + dim] ** 2).sum()
            acting = wall_contact.at_wall_velocities(
                nodes, near.at_wall, near.at, near.d, near.normal, near.index, near.weight, near.free,
                near.acting, near.share, near.stiffness, near.velocity, near.inner,
            )  # fmt: skip
            assert acting > 4
            at_wall = near.velocity[:acting].copy()
            after = np.zeros_like(at_wall)
            if not whole:  # what approaches is stopped, what leaves and what slides is left
                n = near.normal[near.acting[:acting]]
                after = at_wall - np.minimum((at_wall * n).sum(axis=1), 0.0)[:, None] * n
            impulse, held = np.zeros((acting, dim)), np.zeros(acting, dtype=np.uint8)
            of_wall = (
                near.acting[:acting],
                near.at,
                near.normal,
                near.index,
                near.free,
                near.share,
                near.stiffness,
            )
            wall_contact.give(nodes, *of_wall, at_wall, after, False, impulse, held)
            for turn in range(sweeps):
                wall_contact.sweep(nodes, *of_wall, after, whole, whole, turn % 2 == 0, False, impulse, held)
            assert (nodes[:, :1] * nodes[:, 1 : 1 + dim] ** 2).sum() <= before * (1 + 1e-12)
            if not whole:
                n = near.normal[near.acting[:acting]]
                assert (impulse * n).sum(axis=1).min() >= -1e-12  # it pushes and does not pull


CORNERS = {
    "plane-strain": {"x": [-0.5, 1.0], "z": [-0.5, 1.0]},
    "axisymmetric": {"r": [0.0, 1.0], "z": [-0.5, 1.0]},
    "3d": {"x": [-0.5, 1.0], "y": [-0.5, 1.0], "z": [-0.5, 1.0]},
}


@pytest.mark.parametrize("space", CORNERS)
def test_walls_that_meet_are_one_symmetric_constraint(space):
    """Q, which makes the velocities of the nodes those that stick to all walls, is its own transpose in the
    metric of the masses: Σ m (Q a)·b = Σ m a·(Q b), also in corners where walls push the same nodes.

    One after the other, once each, is not: what comes of stress is then not what does work on it, and a
    fluid at rest in a corner flutters.
    """
    dim = len(CORNERS[space])
    upper = np.array([0.412, 0.4, 0.4])[[0, -1] if dim == 2 else [0, 1, 2]]
    lower = upper - 0.163
    x, z = np.eye(dim)[[0, -1]]
    simulation = Simulation(
        mpmkit.parse_case(
            {
                "space": space,
                "until": 1.0,
                "grid": {"cell_size": CELL, "domain": CORNERS[space]},
                "walls": {
                    "floor": wall(lower.tolist(), z.tolist(), "stick"),
                    "side": wall(upper.tolist(), (-x).tolist(), "stick"),
                },
                "bodies": [
                    {
                        "shape": {
                            "kind": "box",
                            "lower": lower.tolist(),
                            "upper": upper.tolist(),
                        },
                        "material": FLUID,
                    }
                ],
            }
        )
    )
    operations = simulation.operations
    operations.begin(0.0)
    operations.map_to_grid()
    walls, nodes = operations.walls, operations.window.nodes
    assert all(part.touches for part in walls.walls)
    shared = np.intersect1d(*(part.near.at[part.near.at_wall] for part in walls.walls))
    assert (nodes[shared, 0] > 0).any()
    own, random, pairs = nodes[:, :1] > 0, np.random.default_rng(3), []
    nodes[:, :1] *= random.uniform(0.5, 1.5, (len(nodes), 1))  # in a lattice, walls at right angles commute
    mass = nodes[:, :1].copy()
    for _ in range(2):
        given = np.where(own, random.standard_normal((len(nodes), dim)), 0.0)
        nodes[:, 1 : 1 + dim] = given
        walls.constrain(operations.faces.given(False))
        pairs.append((given, np.where(own, nodes[:, 1 : 1 + dim], 0.0)))
    (a, qa), (b, qb) = pairs
    assert (mass * np.abs(qa - a)).sum() > 1e-3 * (mass * np.abs(a)).sum()
    assert (mass * qa * b).sum() == pytest.approx((mass * a * qb).sum(), rel=1e-10)


@pytest.mark.parametrize("degrees", [0.0, 25.0, 70.0])
def test_particles_in_a_wall_are_put_to_its_surface(degrees):
    """Along the normal; the others stay."""
    simulation, near = laid(degrees=degrees)
    normal = np.array([-math.sin(math.radians(degrees)), math.cos(math.radians(degrees))])
    foot = np.array([0.3, 0.3]) - simulation.grid.lower
    random = np.random.default_rng(7)
    across = np.array([normal[1], -normal[0]])
    depth, along = random.uniform(-0.9, 0.9, 40) * CELL, random.uniform(-0.2, 0.2, 40)
    places = foot + depth[:, None] * normal + along[:, None] * across
    before = places.copy()
    moved = wall_reach.keep_out(places, CELL, near.lower, near.strides, near.dense)
    assert moved == (depth < 0).sum() > 3
    np.testing.assert_allclose((places - foot) @ normal, np.maximum(depth, 0.0), rtol=0, atol=1e-12)
    np.testing.assert_array_equal(places[depth >= 0], before[depth >= 0])
    np.testing.assert_allclose(places @ across, before @ across, rtol=0, atol=1e-12)


# --- History ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_history_of_walls(tmp_path, space):
    """Force, torque and power of each wall, means over the time since the last row."""
    slope = {**SLOPE, "contact": "stick"}
    data = scene({"slope": slope, "lid": wall([0, 0.9], [0, -1.0])}, velocity=(0.0, -1.0))
    if space == "3d":
        data["space"] = "3d"
        data["grid"]["domain"] = {a: [-0.2, 0.8] for a in "xyz"}
        data["walls"]["slope"]["surface"] = {"kind": "plane", "point": [0, 0, 0.15], "normal": [0.1, 0, 1.0]}
        data["walls"]["lid"]["surface"] |= {"point": [0, 0, 0.7], "normal": [0, 0, -1.0]}
        data["bodies"][0] |= {"velocity": [0, 0, -1.0]}
        data["bodies"][0]["shape"] = {"kind": "box", "lower": [0, 0, 0.2], "upper": [0.2, 0.2, 0.3]}
    data |= {"until": 0.1, "output": {"history_interval": 0.02, "report": False}}
    mpmkit.run(mpmkit.parse_case(data), tmp_path / "run")
    with xarray.open_dataset(tmp_path / "run" / "history.nc") as history:
        history.load()
    axes = ("x", "z") if space != "3d" else ("x", "y", "z")
    assert list(history["wall"].values) == ["slope", "lid"]
    force, torque, power = (history[f"wall_{name}"] for name in ("force", "torque", "power"))
    assert (force.dims, force.attrs["units"]) == (("time", "wall", "component"), "N")
    assert torque.dims == ("time", "wall", "about")
    assert torque.attrs["units"] == "N m"
    assert (power.dims, power.attrs["units"]) == (("time", "wall"), "W")
    assert list(history["component"].values) == list(axes)
    assert list(history["about"].values) == (["y"] if space != "3d" else list(axes))
    for variable in (force, torque, power, history["wall"]):
        assert variable.attrs["long_name"]
    assert not force.sel(wall="lid").any()  # far away
    assert float(force.sel(wall="slope", component="z").max()) > 0
    assert (force.isel(time=0) == 0).all()
    whole = Simulation(mpmkit.parse_case(data))
    while whole.time < 0.1 * (1 - 1e-12):
        whole.advance(0.1 - whole.time)
    means = force.sel(wall="slope").values[1:] * np.diff(history["time"].values)[:, None]
    np.testing.assert_allclose(means.sum(axis=0), whole.wall_sums()[0, : len(axes)], rtol=0.02, atol=1e-3)


def test_history_without_walls_has_none(tmp_path):
    data = scene({}) | {"until": 0.01, "output": {"report": False}}
    del data["walls"]
    mpmkit.run(mpmkit.parse_case(data), tmp_path / "run")
    with xarray.open_dataset(tmp_path / "run" / "history.nc") as history:
        assert not [name for name in history.variables if str(name).startswith("wall_force")]
        assert "wall" not in history.dims


# --- Energy -------------------------------------------------------------------------------------------------


def test_a_plate_that_drags_a_fluid_creates_no_energy():
    """The guard counts the work of the wall; what is left is what the scheme creates, at most none."""
    drag = {"kind": "velocity", "velocity": [1.0, 0.0]}
    simulation = simulated(
        {
            "plate": wall([0.0, 0.39], [0.0, -1.0], "stick", motion=drag),
            "floor": wall([0.0, 0.21], [0.0, 1.0], "stick"),
        },
        lower=(0.0, 0.21),
        upper=(0.4, 0.39),
        gravity=[0, 0],
        material={**FLUID, "viscosity": 50.0},
    )
    while simulation.time < 0.2:
        simulation.advance()
    simulation.guards.check()
    balance = simulation.guards.balance
    assert simulation.walls_work > 0.1
    assert balance.created <= 1e-9 * simulation.walls_work


# --- Beside a face of the grid ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("face", "contact", "gap"),
    [
        ("slip", "slip", 0.0),
        ("slip", "slip", 5e-5),
        ("slip", "stick", 0.0),
        ("slip", "stick", 5e-5),
        ("stick", "slip", 0.0),
        ("stick", "stick", 0.0),
        ({"kind": "friction", "coefficient": 0.5}, "slip", 0.0),
    ],
)
def test_a_piston_that_starts_at_a_face_throws_nothing(face, contact, gap):
    """The free end of what it pushes moves at no more than twice its speed, as in any impact.

    Found by the fuzz: beside a held node the wall's velocity has to come from the next one alone, of which
    the wall's place has a small part, and which got 1/part times as fast.
    """
    motion = {"kind": "velocity", "velocity": [0.5, 0.0]}
    piston = wall([-0.5 - gap, 0.0], [1.0, 0.0], contact, motion=motion)
    block = {"lower": (-0.5, 0.0), "upper": (-0.2, 0.2), "faces": {"x_min": face}, "gravity": [0.0, 0.0]}
    simulation = simulated({"piston": piston}, **block)
    for _ in range(19):
        simulation.advance()
        assert simulation.particles.velocity[:, 0].max() < 1.1


@pytest.mark.parametrize(("face", "point", "speed"), [("x_min", -0.5, 0.5), ("x_max", 1.0, -0.5)])
def test_no_wall_moves_into_the_scene_from_a_plane_of_symmetry(face, point, speed):
    """The plane would go on holding the nodes that the wall has come over."""
    motion = {"kind": "velocity", "velocity": [speed, 0.0]}
    walls = {"piston": wall([point, 0.0], [math.copysign(1, speed), 0.0], "slip", motion=motion)}
    for kind in ("slip", "symmetry"):
        data = scene(walls, faces={face: kind})
        if kind == "slip":
            mpmkit.parse_case(data)
        else:
            sentence = f"piston.surface moves into the scene from {face}, a plane of symmetry"
            with pytest.raises(CaseError, match=sentence):
                mpmkit.parse_case(data)
    along = wall([0.0, 0.1], [0.0, 1.0], "slip", motion=motion)  # its velocity is along itself
    mpmkit.parse_case(scene({"floor": along}, faces={face: "symmetry"}))
