"""Volumes of nodes, and the correction of J where there is more material than volume."""

from __future__ import annotations

import numpy as np
import pytest

import mpmkit
from mpmkit.kernels import nodes
from mpmkit.kernels.domains import volume_within_reach
from mpmkit.solver.node_volumes import node_volumes
from mpmkit.solver.relaxation import CROWDED, MOST, find_crowding

DX, SIDE = 0.1, 0.6
AXES = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}
WALLS = ("slip", "stick", "symmetry", "periodic")


def filled(space, wall="slip", per_axis=2, **scheme):
    """A domain that is full of fluid, between walls of one kind."""
    axes, radial = AXES[space], space == "axisymmetric"
    faces = {f"{axis}_{side}": wall for axis in axes for side in ("min", "max")}
    if radial:
        faces = {f"z_{side}": wall for side in ("min", "max")}
        faces["r_max"] = wall if wall in ("slip", "stick") else "slip"
    cylinder = {"kind": "cylinder", "radius": SIDE, "height": SIDE}
    box = {"kind": "box", "lower": [0.0] * len(axes), "upper": [SIDE] * len(axes)}
    case = {
        "space": space,
        "until": 1.0,
        "gravity": [0.0] * len(axes),
        "grid": {"cell_size": DX, "domain": {axis: [0.0, SIDE] for axis in axes}, "faces": faces},
        "bodies": [
            {
                "shape": cylinder if radial else box,
                "particles_per_cell": per_axis ** len(axes),
                "material": {"law": "newtonian", "viscosity": 0.0, "density": 1000.0, "sound_speed": 10.0},
            }
        ],
        "scheme": {"redistribution": "none"} | scheme,
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    simulation.operations.begin()
    return simulation


def fullness(simulation):
    """Σ V_p N_np over the room of each node that has any of it, what is on ghosts left out."""
    o, p = simulation.operations, simulation.particles
    room = node_volumes(o.window, o.radial)
    measure = np.ones(len(p))
    o.averager.sums(measure, p.volume)
    active = o.sorting.active
    nodes.fold(o.window.pairs, active.faces, active.mirrors, active.plane_first, 0, 2, False)
    found = o.window.pairs[:, 0] / room
    o.window.pairs[:] = 0.0
    return found[found > 0]


@pytest.mark.parametrize("per_axis", [1, 2, 3])
@pytest.mark.parametrize("wall", WALLS)
@pytest.mark.parametrize("space", AXES)
def test_boxes_that_tile_a_domain_fill_its_nodes(space, wall, per_axis):
    """Σ_p V_p N_np = V_n, at walls, edges and corners too; except on the axis, where there is no bound."""
    found = fullness(filled(space, wall, per_axis))
    assert len(found) >= 6**2
    np.testing.assert_allclose(found, 1.0, rtol=1e-12)


@pytest.mark.parametrize("space", AXES)
def test_boxes_that_are_not_on_the_lattice_fill_them_as_well(space):
    """A body that was moved by a part of a cell, or drawn out along one axis and thinned along another."""
    simulation = filled(space, per_axis=2)
    o, p = simulation.operations, simulation.particles
    p.position[:, -1] *= 0.8
    p.half_size[:, -1] *= 0.8
    p.volume *= 0.8
    o.begin()
    found = fullness(simulation)
    assert found.max() == pytest.approx(1.0, rel=1e-12)
    assert np.isclose(found, 1.0, rtol=1e-12).sum() > 0.6 * len(found)  # those below the surface


@pytest.mark.parametrize("space", AXES)
def test_nodes_with_free_volume_are_not_crowded(space):
    crowding = find_crowding(filled(space).operations.averager, space == "axisymmetric")
    assert (crowding == 1.0).all()


@pytest.mark.parametrize("height", [0.97, 0.5])
@pytest.mark.parametrize("space", AXES)
def test_j_of_crowded_particles_tends_to_the_available_volume(space, height):
    """All particles are moved down by a part: by a little, or by so much that the bound acts."""
    simulation = filled(space, volumetric={"name": "nodal-average", "relaxation": 1.0})
    o, p = simulation.operations, simulation.particles
    p.position[:, -1] *= height  # boxes and volumes as they were
    o.mean_speed = DX  # a rate of one
    o.begin()
    crowding = min(1 / height / (1 + CROWDED), MOST)
    if height == 0.5:
        assert find_crowding(o.averager, o.radial).max() == crowding == MOST
    o.relax_volume(0.1)
    inside = p.position[:, -1] < height * SIDE - 2.5 * DX
    assert inside.any()
    if o.radial:
        inside &= p.position[:, 0] > DX
    drawn = 1 - (1 - np.exp(-0.1)) * (1 - 1 / crowding)
    mean = np.average(p.volume_ratio[inside], weights=p.volume[inside])
    assert mean == pytest.approx(drawn, rel=1e-12 if crowding == MOST else 5e-4)
    assert p.volume_ratio.max() <= 1.0


def test_small_relaxations_are_collected():
    """Four steps of a hundredth change nothing; the next step applies all of them together."""
    simulation = filled("plane-strain", volumetric={"name": "nodal-average", "relaxation": 1.0})
    o, p = simulation.operations, simulation.particles
    o.mean_speed = DX
    p.volume_ratio[:] = np.random.default_rng(1).uniform(0.8, 0.95, len(p))
    p.volume[:] = p.volume_ratio * p.initial_volume
    start = p.volume_ratio.copy()
    o.averager.at_nodes(p.volume_ratio, p.initial_volume)
    mean = o.averager.at_particles()
    for _ in range(4):
        o.relax_volume(0.012)
        np.testing.assert_array_equal(p.volume_ratio, start)
    o.relax_volume(0.012)
    np.testing.assert_allclose(p.volume_ratio, start + (1 - np.exp(-0.06)) * (mean - start), rtol=1e-12)


def test_boxes_that_stay_as_they_are_tell_nothing_of_crowding():
    relaxing = {"name": "nodal-average", "relaxation": 1.0}
    simulation = filled("plane-strain", shape="linear", volumetric=relaxing)
    o, p = simulation.operations, simulation.particles
    p.position[:, -1] *= 0.5
    o.mean_speed = DX
    o.begin()
    o.relax_volume(0.1)
    np.testing.assert_allclose(p.volume_ratio, 1.0, rtol=1e-14)


def test_of_a_box_counts_what_is_within_a_cell():
    volume, half_size, within = np.array([2.0, 2.0]), np.array([[0.04, 0.1], [0.2, 0.1]]), np.empty(2)
    volume_within_reach(volume, half_size, DX, within)
    assert within == pytest.approx([2.0 * 0.5, 2.0 * 0.25 * 0.5])
