"""Forces of the faces of the grid on the material: momentum balance, weight, pressure of a fluid."""

from __future__ import annotations

import itertools
import math

import numba
import numpy as np
import pytest
import xarray

import mpmkit
from mpmkit.kernels import nodes

G, CELL = 9.81, 0.05
FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 5.0, "sound_speed": 15.0}
RUB, RELEASING = {"kind": "friction", "coefficient": 0.3}, {"kind": "stick", "releases": True}
AXES = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}
MIXED = ["stick", "slip", RUB, "symmetry", RELEASING, "slip"]
PLANES = {
    "plane-strain": {"point": [-0.02, 0.0], "normal": [1.0, 0.15]},
    "axisymmetric": {"point": [0.26, 0.0], "normal": [-1.0, 0.0]},
    "3d": {"point": [0.0, -0.02, 0.0], "normal": [0.1, 1.0, 0.15]},
}
SCHEMES = list(itertools.product(["usl", "usf", "musl"], ["flip", "pic", "apic"]))


def closed(space, kinds):
    """Faces of these kinds, one after the other; the axis has none."""
    names = [f"{a}_{side}" for a in AXES[space] for side in ("min", "max") if f"{a}_{side}" != "r_min"]
    return dict(zip(names, itertools.cycle(kinds), strict=False))


def thrown(space, faces, order="musl", update="apic", walls=None, **scheme):
    """A block of a fluid in a box not much larger, thrown into a corner of it."""
    dim, radial = len(AXES[space]), space == "axisymmetric"
    room = dict.fromkeys(AXES[space], (-0.05, 0.4)) | ({"r": (0.0, 0.35)} if radial else {})
    if walls:  # they stand on the floor, and not beside another face
        room |= {a: (0.0 if a == "r" else -0.25, 0.6) for a in AXES[space][:-1]}
    shape = {"kind": "box", "lower": [0.0] * dim, "upper": [0.25] * dim}
    if radial:
        shape = {"kind": "cylinder", "radius": 0.25, "height": 0.25, "base": [0.0, 0.0]}
    case = {
        "space": space,
        "until": 1.0,
        "grid": {
            "cell_size": CELL,
            "domain": {a: list(ends) for a, ends in room.items()},
            "faces": faces,
        },
        "walls": walls or {},
        "bodies": [
            {
                "shape": shape,
                "material": FLUID,
                "velocity": [0.0, -1.0] if radial else [-0.2, -0.5, -1.0][3 - dim :],
            }
        ],
        "scheme": {"order": order, "velocity": update, "redistribution": "none", **scheme},
    }
    return mpmkit.Simulation(mpmkit.parse_case(case))


def momentum_off(simulation, steps, axes):
    """|Σ m v - Σ m v₀ - M g t - Σ λ| over Σ |λ|, along some axes: what the particles have too much."""
    p = simulation.particles
    start, mass = p.mass @ p.velocity, p.mass.sum()
    for _ in range(steps):
        simulation.advance()
    dim = p.dim
    given = simulation.wall_sums()[:, :dim]
    off = p.mass @ p.velocity - start - given.sum(axis=0)
    off[-1] += mass * G * simulation.time
    assert np.abs(given).sum() > 0.1 * mass * G * simulation.time  # they have been reached
    return np.abs(off[axes]).max() / np.abs(given).sum()


@pytest.mark.parametrize("kinds", [["slip"], ["stick"], [RUB], [RELEASING]], ids=str)
@pytest.mark.parametrize("space", AXES)
def test_faces_account_for_all_momentum(space, kinds):
    """In every order and velocity update; in 3-D in some of them. Along r, pressure around the axis acts."""
    axes = [-1] if space == "axisymmetric" else slice(None)
    for order, update in SCHEMES[::4] if space == "3d" else SCHEMES:
        simulation = thrown(space, closed(space, kinds), order, update)
        assert momentum_off(simulation, 60 if space == "3d" else 100, axes) < 1e-12, (order, update)


@pytest.mark.parametrize("update", ["flip", "pic", "apic"])
@pytest.mark.parametrize("shape", ["cpgimp", "linear"])
def test_faces_of_different_kinds_in_corners(shape, update):
    """Along the normal of a plane of symmetry its own share is left out."""
    simulation = thrown("3d", closed("3d", MIXED), "musl", update, shape=shape)
    assert simulation.wall_names == ("x_min", "x_max", "y_min", "z_min", "z_max")
    assert momentum_off(simulation, 60, [0, 2]) < 1e-12


@pytest.mark.parametrize("update", ["flip", "pic", "apic"])
def test_faces_beside_periodic_ones(update):
    faces = {"x_min": "periodic", "x_max": "periodic", "z_min": "stick", "z_max": RUB}
    simulation = thrown("plane-strain", faces, "usf", update)
    assert simulation.wall_names == ("z_min", "z_max")
    assert momentum_off(simulation, 100, slice(None)) < 1e-12


def test_a_redistribution_moves_no_momentum_past_the_faces():
    simulation = thrown("plane-strain", closed("plane-strain", MIXED[:3]), redistribution="even")
    assert momentum_off(simulation, 150, slice(None)) < 1e-12
    assert simulation.redistribution_energy != 0.0


@pytest.mark.parametrize("moving", [False, True], ids=["at rest", "moving"])
@pytest.mark.parametrize("contact", ["slip", "stick", {"kind": "coulomb", "coefficient": 0.3}], ids=str)
@pytest.mark.parametrize("face", ["slip", "stick", RELEASING], ids=str)
def test_faces_and_walls_account_for_all_momentum(face, contact, moving):
    """A wall that stands on the floor: the floor balances the impulse of the wall on nodes that it holds."""
    for (order, update), space in zip(SCHEMES[::4], AXES, strict=True):
        velocity = (
            [0.0, 0.1] if space == "axisymmetric" else [0.1 * round(n) for n in PLANES[space]["normal"]]
        )
        surface = {
            "kind": "plane",
            **PLANES[space],
            **({"motion": {"kind": "velocity", "velocity": velocity}} if moving else {}),
        }
        walls = {"slope": {"surface": surface, "contact": contact}}
        simulation = thrown(space, closed(space, [face]), order, update, walls)
        axes = [-1] if space == "axisymmetric" else slice(None)
        assert momentum_off(simulation, 38, axes) < 1e-12, (space, order, update)
        assert simulation.wall_sums()[0].any()


# --- Moment


def raw(simulation):
    """Mass, momentum and force that particles put on the nodes, and the places of these, m."""
    o = simulation.operations
    window, grid = o.window, simulation.grid
    nodes.clear(window.nodes, o.sorting.active.rows, o.sorting.active.tasks)
    o._map(momentum=True, forces=True)
    records = window.nodes.copy()
    number = np.indices(window.shape[: grid.dim]).reshape(grid.dim, -1).T + window.lower
    return records, grid.lower + number * grid.cell_size


def moment(place, impulse):
    """Σ x × λ; in two dimensions about y, the axis out of the plane."""
    if place.shape[1] == 2:
        return [(place[:, 1] * impulse[:, 0] - place[:, 0] * impulse[:, 1]).sum()]
    return np.cross(place, impulse).sum(axis=0)


@pytest.mark.parametrize("kinds", [["slip"], ["stick"], [RUB], [RELEASING], MIXED], ids=str)
@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_impulses_and_moments_are_those_that_the_nodes_took(space, kinds):
    """Step by step, with the masses that particles put on each node: Σ m Δv - Δt Σ f, and Σ x × the same."""
    simulation = thrown(space, closed(space, kinds), "usl")
    o, dim = simulation.operations, simulation.grid.dim
    for step in range(60 if space == "3d" else 80):
        simulation.prepare()
        o.begin(simulation.time)
        if step == 0:
            o.start()
        before, dt = o.faces.sums.copy(), simulation.time_step
        records, place = raw(simulation)
        o.step(dt)
        simulation.time += dt
        m, p, f = records[:, :1], records[:, 1 : 1 + dim], records[:, 1 + dim : 1 + 2 * dim]
        change = o.window.nodes[:, 1 + dim : 1 + 2 * dim]
        mapped = o.window.nodes[:, 1 : 1 + dim] - change
        alpha = flip_of(simulation, dt)
        impulse = m * change - dt * f + (1 - alpha) * (m * mapped - p)
        found = (o.faces.sums - before).sum(axis=0)
        scale = dt * np.abs(f).sum()
        np.testing.assert_allclose(found[:dim], impulse.sum(axis=0), rtol=0, atol=1e-12 * scale)
        np.testing.assert_allclose(found[dim:-1], moment(place, impulse), rtol=0, atol=1e-12 * scale)
    assert np.abs(o.faces.sums[:, dim:-1]).max() > 0


def flip_of(simulation, dt):
    return math.exp(-0.05 / simulation.operations.acoustic_time * dt)


# --- Rest


def tank(**more):
    """Still water of a depth of 0.4 m between two walls, which starts under its weight."""
    case = {
        "space": "plane-strain",
        "until": 0.3,
        "grid": {
            "cell_size": 0.05,
            "domain": {"x": [0.0, 0.3], "z": [0.0, 0.6]},
            "faces": {"x_min": "slip", "x_max": RUB, "z_min": "stick"},
        },
        "bodies": [{"shape": {"kind": "box", "lower": [0, 0], "upper": [0.3, 0.4]}, "material": FLUID}],
        "output": {"history_interval": 0.1, "report": False},
    }
    return mpmkit.parse_case(case | more)


def test_history_of_a_fluid_at_rest(tmp_path):
    """The floor carries the weight, a side wall ρ g H²/2 at a third of the depth; faces do no work."""
    mpmkit.run(tank(), tmp_path / "run")
    with xarray.open_dataset(tmp_path / "run" / "history.nc") as history:
        history.load()
    assert list(history["wall"].values) == ["x_min", "x_max", "z_min"]
    force, torque = history["wall_force"].isel(time=-1), history["wall_torque"].isel(time=-1)
    weight, push = 1000 * G * 0.3 * 0.4, 1000 * G * 0.4**2 / 2
    floor = force.sel(wall="z_min", component="z") + force.sel(wall="x_max", component="z")
    assert float(floor) == pytest.approx(weight, rel=1e-3)
    assert float(force.sel(wall="x_min", component="x")) == pytest.approx(push, rel=0.02)
    assert float(force.sel(wall="x_max", component="x")) == pytest.approx(-push, rel=0.02)
    assert float(force.sel(wall="x_min", component="z")) == 0.0  # slip
    assert float(torque.sel(wall="x_min", about="y")) == pytest.approx(push * 0.4 / 3, rel=0.05)
    assert float(torque.sel(wall="z_min", about="y")) == pytest.approx(-weight * 0.15, rel=0.02)
    assert (history["wall_power"] == 0).all()


def test_walls_of_the_case_come_before_the_faces(tmp_path):
    lid = {"surface": {"kind": "plane", "point": [0.0, 0.5], "normal": [0.0, -1.0]}, "contact": "slip"}
    simulation = mpmkit.Simulation(tank(walls={"lid": lid}))
    assert simulation.wall_names == ("lid", "x_min", "x_max", "z_min")
    assert len(simulation.wall_sums()) == 4


def test_faces_that_are_no_walls_have_no_name():
    faces = {"x_min": "symmetry", "x_max": "open", "z_min": "symmetry"}
    assert thrown("plane-strain", faces).wall_names == ()


def test_same_sums_with_any_number_of_threads():
    found = []
    for threads in (1, 2):
        numba.set_num_threads(threads)
        simulation = thrown("3d", closed("3d", MIXED))
        for _ in range(30):
            simulation.advance()
        found.append(simulation.wall_sums())
    np.testing.assert_array_equal(*found)
