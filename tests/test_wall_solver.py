"""Walls in the solver: their effect on nodes and particles."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from walled import CELL, FLUID, SLOPE, advance, scene, simulated, wall

import mpmkit
from mpmkit.solver.simulation import Simulation

CONCRETE = {
    "law": "bingham-evp",
    "density": 2000.0,
    "yield_stress": 50.0,
    "plastic_viscosity": 20.0,
    "sound_speed": 15.0,
}


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
    """The wall moves by several cells, and its nodes are found again in between."""
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
