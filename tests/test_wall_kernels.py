"""Kernels of walls: symmetric, and no source of energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from walled import CELL, FLUID, advance, scene, wall

import mpmkit
from mpmkit.kernels import ghosts, wall_contact, wall_reach
from mpmkit.solver.simulation import Simulation

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
    """For any velocities of the nodes and any number of sweeps, a wall at rest does not add kinetic
    energy."""
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
                near.acting, near.share, near.inverse_mass, near.velocity, near.inner,
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
                near.inverse_mass,
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
    """They are moved along the normal; the other particles stay."""
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
