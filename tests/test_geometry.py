"""Shapes and the particles that fill them."""

from __future__ import annotations

import itertools
import math
import os
import sys
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from mpmkit.errors import CaseError
from mpmkit.geometry import (
    AnyShape,
    Box,
    Cylinder,
    Frustum,
    Mesh,
    Polygon,
    Sphere,
    expected_count,
    sample,
    shared_volume,
)
from mpmkit.spaces import SPACES

SOLID, PLANE, RADIAL = SPACES["3d"], SPACES["plane-strain"], SPACES["axisymmetric"]
CONE = Frustum(kind="frustum", bottom_radius=0.1, top_radius=0.05, height=0.3)
ROD = Cylinder(kind="cylinder", radius=0.1, height=0.2)
BALL = Sphere(kind="sphere", centre=[0, 0, 0.1], radius=0.1)
BALL_2D = Sphere(kind="sphere", centre=[0, 0.1], radius=0.1)
HOLLOW = Sphere(kind="sphere", centre=[0, 0, 0.1], radius=0.1, inner_radius=0.05)
HOLLOW_2D = Sphere(kind="sphere", centre=[0, 0.1], radius=0.1, inner_radius=0.05)
BLOCK = Box(kind="box", lower=[0, 0, 0], upper=[0.1, 0.2, 0.3])
RING = Box(kind="box", lower=[0.1, 0], upper=[0.3, 0.5])
CORNERS = [[0.05, 0], [0.1, 0], [0.1, 0.2], [0.3, 0.5], [0.05, 0.5]]
"""A funnel with its outlet, which has a corner that points inwards."""
FUNNEL = Polygon(kind="polygon", corners=CORNERS)
HOPPER = Polygon(kind="polygon", corners=CORNERS[::-1], y=[-0.1, 0.05])

EXACT = [
    (CONE, SOLID, math.pi * 0.3 / 3 * (0.01 + 0.005 + 0.0025)),
    (CONE, RADIAL, math.pi * 0.3 / 3 * (0.01 + 0.005 + 0.0025)),
    (CONE, PLANE, 0.3 * 0.15),
    (ROD, SOLID, math.pi * 0.01 * 0.2),
    (ROD, RADIAL, math.pi * 0.01 * 0.2),
    (ROD, PLANE, 0.2 * 0.2),
    (BALL, SOLID, 4 / 3 * math.pi * 0.001),
    (BALL_2D, RADIAL, 4 / 3 * math.pi * 0.001),
    (BALL_2D, PLANE, math.pi * 0.01),
    (HOLLOW, SOLID, 4 / 3 * math.pi * (0.001 - 0.05**3)),
    (HOLLOW_2D, PLANE, math.pi * (0.01 - 0.0025)),
    (HOLLOW_2D, RADIAL, 4 / 3 * math.pi * (0.001 - 0.05**3)),
    (BLOCK, SOLID, 0.006),
    (RING, PLANE, 0.1),
    (RING, RADIAL, math.pi * (0.09 - 0.01) * 0.5),
    (FUNNEL, PLANE, 0.05 * 0.2 + 0.3 * 0.15),
    (FUNNEL, RADIAL, math.pi * (0.01 * 0.2 + 0.3 * (0.01 + 0.03 + 0.09) / 3 - 0.0025 * 0.5)),
    (HOPPER, SOLID, 0.15 * (0.05 * 0.2 + 0.3 * 0.15)),
]
each = pytest.mark.parametrize(
    ("shape", "space", "volume"), EXACT, ids=[f"{shape.kind}-{space.name}" for shape, space, _ in EXACT]
)


def fill(shape, space, cell=0.01, per_axis=2, keep=None, origin=0.0):
    return sample(
        shape, space, origin=[origin] * space.dim, cell_size=cell, per_axis=[per_axis] * space.dim, keep=keep
    )


@each
def test_volume_is_exact(shape, space, volume):
    assert shape.volume(space) == pytest.approx(volume, rel=1e-14)


@each
def test_containment_agrees_with_volume_and_bounds(shape, space, volume):
    lower, upper = shape.bounds(space)
    points = np.random.default_rng(1).uniform(lower, upper, (200_000, space.dim))
    weight = space.particle_volume(points, (upper - lower))
    inside = shape.contains(points, space)
    assert weight[inside].sum() / len(points) == pytest.approx(volume, rel=0.01)
    outside = np.concatenate(
        [lower + (upper - lower) * (np.eye(space.dim) * 1.02), [lower - 1e-6], [upper + 1e-6]]
    )
    assert not shape.contains(outside, space).any()


@each
def test_particles_have_the_exact_total_and_expected_count(shape, space, volume):
    particles = fill(shape, space, cell=0.01)
    assert particles.volume.sum() == pytest.approx(volume, rel=1e-12)
    assert len(particles.volume) == pytest.approx(
        expected_count(shape, space, 0.01, [2] * space.dim), rel=0.02
    )
    assert particles.half_size.shape == particles.position.shape
    assert shape.contains(particles.position, space).all()
    whole = (particles.half_size == 0.0025).all(axis=1)
    assert whole.mean() > 0.7
    boxes = space.particle_volume(particles.position, 2 * particles.half_size)
    np.testing.assert_allclose(
        particles.volume[whole], boxes[whole], rtol=0.01
    )  # some were counted by points
    np.testing.assert_allclose(particles.volume[~whole], boxes[~whole], rtol=0.03)
    assert 0.49 < particles.half_size.min() / 0.0025 <= particles.half_size.max() / 0.0025 < 2
    if space.radial:
        assert (particles.position[:, 0] > 0).all()


def test_particles_stand_on_the_lattice():
    particles = sample(
        Box(kind="box", lower=[0, 0], upper=[0.2, 0.1]),
        PLANE,
        origin=[-0.3, 0.0],
        cell_size=0.1,
        per_axis=[2, 1],
    )
    expected = [[0.025, 0.05], [0.075, 0.05], [0.125, 0.05], [0.175, 0.05]]
    np.testing.assert_allclose(particles.position, expected, rtol=1e-13)
    np.testing.assert_allclose(particles.volume, 0.005, rtol=1e-13)
    np.testing.assert_allclose(particles.half_size, [[0.025, 0.05]] * 4, rtol=1e-13)


@pytest.mark.parametrize("origin", [0.0, -0.3, -7.77, 0.1 + 0.2 - 0.3])
@pytest.mark.parametrize("per_axis", [1, 2, 3])
def test_a_box_of_whole_cells_is_filled_wholly(origin, per_axis):
    box = Box(kind="box", lower=[0, 0], upper=[0.1, 0.07])
    assert len(fill(box, PLANE, 0.01, per_axis, origin=origin).volume) == 70 * per_axis**2


@pytest.mark.parametrize("origin", [0.0, -0.3, -7.77])
def test_points_on_the_surface_are_inside_whatever_the_rounding(origin):
    box = Box(kind="box", lower=[0.005, 0.005], upper=[0.105, 0.075])
    assert len(fill(box, PLANE, 0.01, 1, origin=origin).volume) == 11 * 8


def test_the_seeds_cone_has_the_published_number_of_particles():
    for corner in (-0.2, -0.2025):  # the axis on a node, in the middle of a cell
        particles = sample(CONE, SOLID, origin=[corner, corner, 0], cell_size=0.005, per_axis=[2, 2, 2])
        assert len(particles.volume) == 351_860
    assert expected_count(CONE, SOLID, 0.005, [2, 2, 2]) == pytest.approx(351_860, rel=1e-4)
    assert len(fill(CONE, RADIAL, 0.005).volume) == 3_600


@pytest.mark.parametrize("shape", [CONE, ROD, BALL], ids=lambda shape: shape.kind)
@pytest.mark.parametrize("per_axis", [1, 2, 3])
def test_a_quarter_has_a_quarter_of_the_mass(shape, per_axis):
    all_of_it = fill(shape, SOLID, 0.02, per_axis, origin=-0.4)
    keep = ([0, 0, 0], [1, 1, 1])
    quarter = fill(shape, SOLID, 0.02, per_axis, keep=keep)
    assert 4 * len(quarter.volume) == len(all_of_it.volume)
    assert quarter.volume.sum() == pytest.approx(shape.volume(SOLID) / 4, rel=1e-12)
    assert (quarter.position > 0).all()
    assert set(quarter.volume) == set(all_of_it.volume)  # to the bit
    count = expected_count(shape, SOLID, 0.02, [per_axis] * 3)
    assert expected_count(shape, SOLID, 0.02, [per_axis] * 3, keep) == pytest.approx(count / 4)


@pytest.mark.parametrize("place", [0.005, 0.0025, 0.0431, -0.0999])
def test_parts_side_by_side_share_no_room_and_weigh_what_they_hold(place):
    parts = [fill(BALL, SOLID, keep=([low, -1, -1], [high, 1, 1])) for low, high in ((-1, place), (place, 1))]
    for part, depth in zip(parts, (place + 0.1, 0.1 - place), strict=True):
        cap = math.pi * depth**2 * (0.3 - depth) / 3
        assert part.volume.sum() == pytest.approx(cap, rel=1e-9) or depth < 0.0025  # thinner than half a box
    assert ((parts[0].position + parts[0].half_size)[:, 0] <= place + 1e-15).all()
    assert ((parts[1].position - parts[1].half_size)[:, 0] >= place - 1e-15).all()


FACES = {"a lattice plane": 0.03, "a sliver": 0.0302, "a quarter": 0.03125, "half": 0.0325, "most": 0.0347}


@pytest.mark.parametrize("end", FACES.values(), ids=FACES)
@pytest.mark.parametrize("start", [0.0, 0.0049, 0.0101, 0.0024, 0.0076])
@pytest.mark.parametrize("space", [SOLID, PLANE, RADIAL], ids=lambda space: space.name)
@pytest.mark.parametrize(("per_axis", "least", "most"), [(1, 0.5, 1.0), (2, 0.75, 1.5)])
def test_the_boxes_of_a_block_tile_it_wherever_its_faces_are(space, start, end, per_axis, least, most):
    """Without a factor of volume: no slivers, none wider than a cell, side by side, from face to face."""
    block = Box(kind="box", lower=[start] * space.dim, upper=[*[0.02 + start] * (space.dim - 1), end])
    particles = fill(block, space, per_axis=per_axis)
    low, high = particles.position - particles.half_size, particles.position + particles.half_size
    np.testing.assert_allclose(low.min(axis=0), block.lower, atol=1e-16)
    np.testing.assert_allclose(high.max(axis=0), block.upper, atol=1e-16)
    widths = 2 * particles.half_size * per_axis / 0.01
    assert (widths >= least * (1 - 1e-9)).all()
    assert (widths <= most * (1 + 1e-9)).all()
    own = space.particle_volume(particles.position, 2 * particles.half_size)
    np.testing.assert_allclose(particles.volume, own, rtol=1e-12)
    assert own.sum() == pytest.approx(block.volume(space), rel=1e-12)
    for axis in range(space.dim):
        ends = np.unique(np.round(np.concatenate([low[:, axis], high[:, axis]]), 12))
        assert len(ends) == len(np.unique(np.round(particles.position[:, axis], 12))) + 1


@pytest.mark.parametrize(("shape", "space"), [(ROD, SOLID), (ROD, RADIAL), (CONE, SOLID), (CONE, PLANE)])
def test_the_flat_ends_of_a_round_body_stay_where_they_are(shape, space):
    body = shape.model_copy(update={"height": 0.2126, "base": [0.0] * (space.dim - 1) + [0.0017]})
    particles = fill(body, space, 0.025)
    assert (particles.position - particles.half_size)[:, -1].min() == pytest.approx(0.0017, abs=1e-15)
    assert (particles.position + particles.half_size)[:, -1].max() == pytest.approx(0.2143, abs=1e-15)
    assert particles.volume.sum() == pytest.approx(body.volume(space), rel=1e-12)
    if space.radial:
        assert (particles.position + particles.half_size)[:, 0].max() == pytest.approx(0.1, abs=1e-15)


@each
def test_parts_of_a_shape_add_up_to_the_points_in_them(shape, space, volume):
    lower, upper = shape.bounds(space)
    place = lower + np.array([0.31, 0.62, 0.83])[: space.dim] * (upper - lower)
    points = np.random.default_rng(3).uniform(lower, upper, (200_000, space.dim))
    weight = space.particle_volume(points, upper - lower) * shape.contains(points, space) / len(points)
    for above in itertools.product((False, True), repeat=space.dim):
        low, high = np.where(above, place, lower), np.where(above, upper, place)
        inside = ((points >= low) & (points <= high)).all(axis=1)
        found = shape.volume_between(low, high, space)
        assert found == pytest.approx(weight[inside].sum(), abs=0.005 * volume)
    assert shape.volume_between(lower - 1, upper + 1, space) == shape.volume(space)
    assert shape.volume_between(upper + 1, upper + 2, space) == 0


def test_parts_of_round_bodies_are_exact():
    """A cap of a sphere, a segment of a cylinder, and a ring of a cone."""
    big = np.array([1.0, 1.0, 1.0])
    cap = BALL.volume_between(np.array([0.04, -1, -1]), big, SOLID)
    assert cap == pytest.approx(math.pi * 0.06**2 * (0.3 - 0.06) / 3, rel=1e-10)
    segment = 0.01 * math.acos(0.4) - 0.04 * math.sqrt(0.01 - 0.04**2)
    assert ROD.volume_between(np.array([0.04, -1, -1]), big, SOLID) == pytest.approx(0.2 * segment, rel=1e-12)
    # Above r = 0.07 the cone's wall reaches to z = 0.18.
    ring = math.pi * 0.18 / 3 * (0.01 + 0.007 + 0.0049) - math.pi * 0.0049 * 0.18
    assert CONE.volume_between(np.array([0.07, 0]), big[:2], RADIAL) == pytest.approx(ring, rel=1e-12)


@each
@pytest.mark.parametrize("place", [0.02, 0.036, 0.0431])
def test_a_body_cut_off_centre_has_the_volume_of_what_is_left(shape, space, volume, place):
    """A plane of symmetry along the last axis but one, and along the last."""
    for axis in (space.dim - 2, space.dim - 1):
        lower, upper = np.full(space.dim, -1.0), np.full(space.dim, 1.0)
        lower[axis] = place
        part = fill(shape, space, keep=(lower, upper)).volume.sum()
        assert part == pytest.approx(shape.volume_between(lower, upper, space), rel=1e-12)
        upper[axis], lower[axis] = place, -1.0
        rest = fill(shape, space, keep=(lower, upper)).volume.sum()
        assert part + rest == pytest.approx(volume, rel=1e-9)


def whole(space):
    return np.full(space.dim, -1.0), np.full(space.dim, 1.0)


TOUCHING = {
    "on a row of lattice points": (
        Box(kind="box", lower=[0, 0], upper=[0.305, 0.2]),
        Box(kind="box", lower=[0.305, 0], upper=[0.5, 0.2]),
        PLANE,
    ),
    "discs in a lattice point": (
        BALL_2D,
        Sphere(kind="sphere", centre=[0.2, 0.1], radius=0.1),
        PLANE,
    ),
    "a cone under a rod": (CONE, ROD.model_copy(update={"base": [0.0, 0.0, 0.3]}), SOLID),
    "a ball on a block": (BALL, Box(kind="box", lower=[-0.1, -0.1, -0.1], upper=[0.1, 0.1, 0.0]), SOLID),
    "side by side, bounds within each other": (
        Sphere(kind="sphere", centre=[0.0, 0.0], radius=0.1),
        Sphere(kind="sphere", centre=[0.12, 0.16], radius=0.1),
        PLANE,
    ),
}


@pytest.mark.parametrize("touching", TOUCHING.values(), ids=TOUCHING)
def test_bodies_that_touch_share_no_volume(touching):
    first, second, space = touching
    for a, b in ((first, second), (second, first)):
        assert shared_volume(a, b, space, [0.01] * space.dim, whole(space)) == 0


def test_an_overlap_thinner_than_a_particle_is_measured():
    low, high = (Box(kind="box", lower=[0, z], upper=[0.2, end]) for z, end in ((0, 0.2), (0.196, 0.3)))
    found = shared_volume(low, high, PLANE, [0.01, 0.01], whole(PLANE))
    assert found == pytest.approx(0.2 * 0.004, rel=1e-12)
    assert shared_volume(low, high, PLANE, [0.01, 0.01], ([-1, -1], [0, 1])) == 0  # outside the domain
    disc = Cylinder(kind="cylinder", radius=0.1, height=0.1, base=[0, 0, 0.196])
    found = shared_volume(ROD, disc, SOLID, [0.01] * 3, whole(SOLID))
    assert found == pytest.approx(math.pi * 0.01 * 0.004, rel=0.02)
    lens = Sphere(kind="sphere", centre=[0.0, 0.298], radius=0.1)
    exact = 2 * math.pi * 0.001**2 * (0.3 - 0.001) / 3
    assert shared_volume(BALL_2D, lens, RADIAL, [0.01] * 2, whole(RADIAL)) == pytest.approx(exact, rel=0.1)


def test_a_body_between_lattice_points_gets_no_particles():
    crumb = Sphere(kind="sphere", centre=[0.5, 0.5, 0.5], radius=0.01)
    particles = fill(crumb, SOLID, 1.0)
    assert particles.position.shape == particles.half_size.shape == (0, 3)
    assert particles.volume.shape == (0,)
    assert expected_count(crumb, SOLID, 1.0, [2, 2, 2], ([2, 2, 2], [3, 3, 3])) == 0


@pytest.mark.parametrize(
    ("shape", "space", "words"),
    [
        (BLOCK, PLANE, ["lower", "[0.0, 0.0, 0.0]", "2 numbers (x, z)"]),
        (RING, SOLID, ["lower", "[0.1, 0.0]", "3 numbers (x, y, z)"]),
        (BALL, RADIAL, ["centre", "2 numbers (r, z)"]),
        (Sphere(kind="sphere", centre=[0.1, 0], radius=1), RADIAL, ["centre", "[0.1, 0.0]", "[0, z]"]),
        (ROD.model_copy(update={"base": [0.2, 0.0]}), RADIAL, ["cylinder's base", "[0.2, 0.0]", "[0, z]"]),
        (CONE.model_copy(update={"base": [0.0, 0.0]}), SOLID, ["frustum's base", "3 numbers"]),
        (Box(kind="box", lower=[-1, 0], upper=[1, 1]), RADIAL, ["lower", "[-1.0, 0.0]", "at least 0"]),
        (FUNNEL, SOLID, ["y is None", "3d", "needs y"]),
        (HOPPER, PLANE, ["y is [-0.1, 0.05]", "has no y"]),
        (Polygon(kind="polygon", corners=[[-1, 0], [1, 0], [0, 1]]), RADIAL, ["[-1.0, 0.0]", "at least 0"]),
        (Mesh(kind="mesh", file="a.stl"), PLANE, ["a.stl", "only in 3d"]),
        (Mesh(kind="mesh", file="nowhere.stl"), SOLID, ["nowhere.stl", "no such file"]),
    ],
)
def test_a_shape_that_the_space_cannot_hold_is_refused(shape, space, words):
    with pytest.raises(ValueError, match=shape.kind) as checked:
        shape.check(space)
    with pytest.raises(CaseError) as used:
        fill(shape, space)
    assert str(checked.value) == str(used.value)
    for word in words:
        assert word in str(used.value)


@pytest.mark.parametrize(
    "bad",
    [
        {"kind": "frustum", "bottom_radius": 0, "top_radius": 0, "height": 1},
        {"kind": "cylinder", "radius": 0, "height": 1},
        {"kind": "cylinder", "radius": 1, "height": math.inf},
        {"kind": "box", "lower": [0, 0], "upper": [1, 0]},
        {"kind": "box", "lower": [0, 0], "upper": [1, 1, 1]},
        {"kind": "sphere", "centre": [0], "radius": 1},
        {"kind": "sphere", "centre": [0, 0], "radius": 1, "colour": "red"},
        {"kind": "mesh", "file": "a.stl", "scale": 0},
        {"kind": "sphere", "centre": [0, 0], "radius": 1, "inner_radius": 1},
        {"kind": "polygon", "corners": [[0, 0], [1, 0]]},
        {"kind": "polygon", "corners": [[0, 0], [1, 0], [2, 0]]},
        {"kind": "polygon", "corners": [[0, 0], [1, 1], [1, 0], [0, 1]]},
        {"kind": "polygon", "corners": [[0, 0], [1, 0], [0, 1, 2]]},
        {"kind": "polygon", "corners": [[0, 0], [1, 0], [0, 1]], "y": [1, 1]},
        {"kind": "torus"},
    ],
)
def test_nonsense_is_refused(bad):
    with pytest.raises(ValidationError):
        TypeAdapter(AnyShape).validate_python(bad)


@pytest.mark.parametrize("shape", [CONE, ROD, BALL, BLOCK, Mesh(kind="mesh", file="a.stl")])
def test_shapes_survive_json(shape):
    adapter = TypeAdapter(AnyShape)
    assert adapter.validate_json(adapter.dump_json(shape)) == shape


def write(path, vertices, faces):
    trimesh = pytest.importorskip("trimesh")
    trimesh.Trimesh(vertices, faces, process=False).export(path)
    return str(path)


def icosphere(radius, subdivisions=4):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.icosphere(subdivisions, radius=radius)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


@pytest.mark.parametrize("name", ["ball.stl", "ball.obj", "ball.ply"])
def test_a_mesh_is_filled_as_the_sphere_that_it_resembles(tmp_path, name):
    vertices, faces = icosphere(100.0)
    mesh = Mesh(kind="mesh", file=write(tmp_path / name, vertices, faces), scale=0.001, translate=[0, 0, 0.1])
    mesh.check(SOLID)
    assert mesh.volume(SOLID) == pytest.approx(BALL.volume(SOLID), rel=5e-3)
    np.testing.assert_allclose(mesh.bounds(SOLID), BALL.bounds(SOLID), atol=1e-6)
    particles, reference = fill(mesh, SOLID), fill(BALL, SOLID)
    assert len(particles.volume) == pytest.approx(len(reference.volume), rel=0.01)
    assert particles.volume.sum() == pytest.approx(mesh.volume(SOLID), rel=1e-12)
    # Lattice points in the planes of symmetry, where the icosphere has corners and edges.
    points = np.random.default_rng(2).integers(-12, 13, (2000, 3)) * 0.01 + [0, 0, 0.1]
    distance = np.linalg.norm(points - [0, 0, 0.1], axis=1)
    clear = abs(distance - 0.1) > 0.0005
    np.testing.assert_array_equal(mesh.contains(points, SOLID)[clear], (distance < 0.1)[clear])


BLOCK_CORNERS = np.array([[x, y, z] for x in (0, 0.1) for y in (0, 0.2) for z in (0, 0.3)])
BLOCK_QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


@pytest.mark.parametrize("turned", [[], [0], [1, 4], range(6)])
def test_quadrilaterals_are_split_and_normals_turned(tmp_path, turned):
    pytest.importorskip("trimesh")
    lines = [f"v {x} {y} {z}" for x, y, z in BLOCK_CORNERS]
    for number, face in enumerate(BLOCK_QUADS + 1):
        lines.append("f " + " ".join(map(str, face[::-1] if number in turned else face)))
    (tmp_path / "block.obj").write_text("\n".join(lines) + "\n")
    mesh = Mesh(kind="mesh", file=str(tmp_path / "block.obj"))
    assert mesh.volume(SOLID) == pytest.approx(0.006, rel=1e-12)
    for shift in (0.0, 0.0025):  # the second puts lattice points on the faces: inside, as for the box
        np.testing.assert_array_equal(
            fill(mesh, SOLID, origin=shift).position, fill(BLOCK, SOLID, origin=shift).position
        )


@pytest.mark.parametrize("inward", [False, True])
def test_a_shell_within_another_is_a_cavity(tmp_path, inward):
    outer, faces = icosphere(0.1, 3)
    vertices = np.concatenate([outer, outer / 2, outer / 4 + [1, 0, 0]])
    hole = faces[:, ::-1] if inward else faces
    shells = np.concatenate([faces, hole + len(outer), faces[:, ::-1] + 2 * len(outer)])
    mesh = Mesh(kind="mesh", file=write(tmp_path / "hollow.stl", vertices, shells))
    ball = 4 / 3 * math.pi * 0.001
    assert mesh.volume(SOLID) == pytest.approx(ball * (1 - 1 / 8 + 1 / 64), rel=0.02)
    points = np.array([[0, 0, 0], [0.07, 0, 0], [0.5, 0, 0], [1, 0, 0]])
    assert mesh.contains(points, SOLID).tolist() == [False, True, False, True]


@pytest.mark.parametrize("far", [0.0, 1e3])
def test_a_point_on_a_meshs_surface_is_inside_and_one_just_off_it_is_not(tmp_path, far):
    trimesh = pytest.importorskip("trimesh")
    file = write(tmp_path / "ball.ply", *icosphere(1.0, 3))
    mesh = Mesh(kind="mesh", file=file, translate=[far, far, far])
    ball = trimesh.load(file)
    points, triangles = trimesh.sample.sample_surface(ball, 2000, seed=1)
    for off, inside in {-4e-6: True, -1e-6: True, 1e-6: True, 4e-6: False, 1e-3: False}.items():
        moved = points + off * ball.face_normals[triangles] + far
        assert (mesh.contains(moved, SOLID) == inside).all()
    assert mesh.contains(np.empty((0, 3)), SOLID).shape == (0,)


def test_bad_meshes_are_refused_by_name(tmp_path):
    vertices, faces = icosphere(0.1, 1)
    flat = BLOCK_CORNERS * [1, 1, 0]
    quads = np.concatenate([BLOCK_QUADS[:, [0, 1, 2]], BLOCK_QUADS[:, [0, 2, 3]]])
    twice = np.concatenate([faces, faces])
    beside = np.concatenate([CUBE, np.add(CUBE, [0.1, 0, 0])]), np.concatenate([CUBE_FACES, CUBE_FACES + 8])
    for file, words in {
        write(tmp_path / "twice.stl", vertices, twice): "120 edges belong to more than two triangles",
        write(tmp_path / "beside.stl", *beside): "5 edges .* shells of it touch there, .* must be united",
        write(tmp_path / "open.stl", vertices, faces[1:]): "not closed",
        write(tmp_path / "flat.ply", flat, quads): "closed",
        text(tmp_path / "words.stl", "these are only words"): "truncated or not an STL file",
        text(tmp_path / "words.ply", "these are only words"): "does not begin with 'ply'",
        text(tmp_path / "words.xyz", "these are only words"): "cannot be read",
        text(tmp_path / "points.obj", "v 0 0 0"): "no triangles",
        text(tmp_path / "nothing.obj", ""): "is empty",
        str(tmp_path): "a folder; it must be a file",
    }.items():
        with pytest.raises(CaseError, match=words) as refused:
            Mesh(kind="mesh", file=file).volume(SOLID)
        assert file in str(refused.value)


def text(path, content):
    path.write_text(content)
    return str(path)


CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * 0.1
CUBE_FACES = np.concatenate([BLOCK_QUADS[:, [0, 1, 2]], BLOCK_QUADS[:, [0, 2, 3]]])


def shells(*parts):
    """Cubes, each with its size and shift, as one surface."""
    corners = np.concatenate([CUBE * size + shift for size, shift in parts])
    return corners, np.concatenate([CUBE_FACES + 8 * number for number in range(len(parts))])


OVERLAPPING = {
    "half in each other": shells((1, [0, 0, 0]), (1, [0.05, 0, 0])),
    "one pokes out of the other": shells((1, [0, 0, 0]), (0.6, [0.06, 0.02, 0.02])),
    "a corner": shells((1, [0, 0, 0]), (1, [0.095, 0.095, 0.095])),
    "an edge, with faces in one plane": shells((1, [0, 0, 0]), (1, [0.095, 0.095, 0])),
    "a thin slice": shells((1, [0, 0, 0]), (1, [0.0999, 0, 0])),
}


@pytest.mark.parametrize("surface", OVERLAPPING.values(), ids=OVERLAPPING)
@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_shells_that_overlap_are_refused(tmp_path, surface, scale):
    """Their masses would be added, or one subtracted from the other as if it were a cavity."""
    mesh = Mesh(kind="mesh", file=write(tmp_path / "cubes.ply", *surface), scale=scale)
    with pytest.raises(
        CaseError, match=r"cubes\.ply, but its surface crosses itself, or shells of it overlap, near"
    ):
        mesh.volume(SOLID)


def test_a_surface_that_crosses_itself_is_refused(tmp_path):
    """A block of which one end is turned over: its walls cross half way."""
    corners = BLOCK_CORNERS.copy()
    corners[[1, 3, 5, 7]] = corners[[3, 1, 7, 5]]
    mesh = Mesh(kind="mesh", file=write(tmp_path / "bow.ply", corners, CUBE_FACES))
    with pytest.raises(CaseError, match="crosses itself"):
        mesh.volume(SOLID)
    corners[[1, 5], 1] *= 1.5  # so that the two halves do not cancel
    mesh = Mesh(kind="mesh", file=write(tmp_path / "bow_tie.ply", corners, CUBE_FACES))
    with pytest.raises(CaseError, match="crosses itself"):
        mesh.volume(SOLID)


@pytest.mark.parametrize("shift", [[0.1, 0.03, 0.02], [0.1001, 0, 0], [0.3, 0, 0]])
def test_shells_that_touch_or_stand_apart_are_added(tmp_path, shift):
    file = write(tmp_path / "cubes.ply", *shells((1, [0, 0, 0]), (1, shift)))
    assert Mesh(kind="mesh", file=file).volume(SOLID) == pytest.approx(0.002, rel=1e-6)


def obj(corners, faces, line="f {} {} {}"):
    lines = ["v " + " ".join(map(str, corner)) for corner in corners]
    return "\n".join([*lines, *(line.format(*(face + 1)) for face in faces), ""])


def ply(names, corners, *, elements="", rows="", face="property list uchar int vertex_indices"):
    head = "".join(f"property float {name}\n" for name in names)
    body = "".join(" ".join(map(str, row)) + "\n" for row in corners)
    ends = " 7" * (face.count("property") - 1) + "\n"
    body += rows + "".join("3 " + " ".join(map(str, triangle)) + ends for triangle in CUBE_FACES)
    kinds = f"element vertex 8\n{head}{elements}element face 12\n{face}\n"
    return f"ply\nformat ascii 1.0\n{kinds}end_header\n{body}"


def stl(word=str.lower, before_the_end=""):
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in CUBE[face])
        + "endloop\nendfacet\n"
        for face in CUBE_FACES
    )
    return word(f"solid cube\n{facets}{before_the_end}endsolid cube\n")


NORMALS = np.full((8, 3), 9)
GOOD = {
    "normals.obj": obj(CUBE, CUBE_FACES, "f {}//1 {}//1 {}//1").replace("f", "vn 0 0 1\nf", 1),
    "texture.obj": obj(CUBE, CUBE_FACES, "f {}/1 {}/1 {}/1").replace("f", "vt 0 0\nf", 1),
    "both.obj": obj(CUBE, CUBE_FACES, "f {}/1/1 {}/1/1 {}/1/1").replace("f", "vt 0 0\nvn 0 0 1\nf", 1),
    "relative.obj": obj(CUBE, CUBE_FACES - 9),
    "comments.obj": "# a cube\no cube\n"
    + obj(CUBE, CUBE_FACES).replace("f ", "s off\nusemtl red # f 1\nf ", 1),
    "goes_on.obj": obj(CUBE, CUBE_FACES, "f {} {} \\\n {}"),
    "colours.obj": obj(np.hstack([CUBE, NORMALS]), CUBE_FACES),
    "quads.obj": obj(CUBE, BLOCK_QUADS, "f {} {} {} {}"),
    "capitals.stl": stl(str.upper),
    "blank_line.stl": stl(before_the_end="\n\n"),
    "normals_first.ply": ply(["nx", "ny", "nz", "x", "y", "z"], np.hstack([NORMALS, CUBE])),
    "backwards.ply": ply(["z", "y", "x"], CUBE[:, ::-1]),
    "colours.ply": ply(
        ["x", "y", "z", "red"],
        np.hstack([CUBE, NORMALS[:, :1]]),
        face="property list uchar int vertex_indices\nproperty uchar red",
    ),
    "edges.ply": ply(
        "xyz", CUBE, elements="element edge 1\nproperty int vertex1\nproperty int vertex2\n", rows="0 1\n"
    ),
}


@pytest.mark.parametrize("name", GOOD)
def test_files_as_programs_write_them_are_read(tmp_path, name):
    pytest.importorskip("igl")
    mesh = Mesh(kind="mesh", file=text(tmp_path / name, GOOD[name]))
    assert mesh.volume(SOLID) == pytest.approx(0.001, rel=1e-6)
    np.testing.assert_allclose(mesh.bounds(SOLID), [[0, 0, 0], [0.1, 0.1, 0.1]], atol=1e-8)


def test_axes_of_a_ply_file_go_by_their_names(tmp_path):
    pytest.importorskip("igl")
    mesh = Mesh(kind="mesh", file=text(tmp_path / "zyx.ply", ply(["z", "y", "x"], CUBE * [3, 2, 1])))
    np.testing.assert_allclose(mesh.bounds(SOLID)[1], [0.1, 0.2, 0.3], rtol=1e-6)


def test_relative_corners_count_from_the_face_that_names_them(tmp_path):
    pytest.importorskip("igl")
    cubes = obj(CUBE, CUBE_FACES - 9) + obj(CUBE + 1, CUBE_FACES - 9)
    mesh = Mesh(kind="mesh", file=text(tmp_path / "two.obj", cubes))
    assert mesh.volume(SOLID) == pytest.approx(0.002, rel=1e-9)
    assert mesh.contains(CUBE.mean(axis=0)[None] + [[0.0], [1.0]], SOLID).all()


def test_polygons_of_more_than_four_corners_are_not_dropped(tmp_path):
    """A prism on a pentagon, and a cube beside it."""
    pytest.importorskip("igl")
    angle = 2 * math.pi * np.arange(5) / 5
    ring = 0.1 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1) + 1
    corners = np.concatenate([CUBE, ring, ring + np.array([0, 0, 0.2])])
    content = obj(corners, CUBE_FACES) + "f 9 10 11 12 13\nf 14 15 16 17 18\n"
    content += "".join(f"f {9 + i} {9 + (i + 1) % 5} {14 + (i + 1) % 5} {14 + i}\n" for i in range(5))
    mesh = Mesh(kind="mesh", file=text(tmp_path / "prism.obj", content))
    exact = 0.001 + 5 / 2 * 0.01 * math.sin(2 * math.pi / 5) * 0.2
    assert mesh.volume(SOLID) == pytest.approx(exact, rel=1e-12)


DAMAGED = {
    "truncated.stl": (stl()[:-300], "truncated: 'endsolid' is missing"),
    "truncated.ply": (ply("xyz", CUBE)[:-40], "truncated: its head announces 20 lines, but it has 1"),
    "head.ply": (ply("xyz", CUBE)[:60], "truncated or damaged: 'end_header' is missing"),
    "beyond.obj": (obj(CUBE, CUBE_FACES) + "f 1 2 99\n", "its line 21 names corner 99, but it has 8 corners"),
    "zero.obj": (obj(CUBE, CUBE_FACES) + "f 0 1 2\n", "its line 21 is 'f 0 1 2'; it must be"),
    "before.obj": (obj(CUBE, CUBE_FACES) + "f -1 -2 -9\n", "its line 21 is 'f -1 -2 -9'; it must be"),
    "words.obj": ("v 0 0 up\n" + obj(CUBE, CUBE_FACES), "its line 1 is 'v 0 0 up'; it must be"),
    "beyond.ply": (ply("xyz", CUBE).replace("3 4 7 5", "3 4 7 55"), "name corners that it does not have"),
    "nan.obj": (obj(CUBE, CUBE_FACES).replace("v 0.1 0.1 0.1", "v 0.1 0.1 nan"), "not finite numbers"),
}


@pytest.mark.parametrize("name", DAMAGED)
def test_a_damaged_file_is_told_what_is_wrong_with_it(tmp_path, name):
    pytest.importorskip("igl")
    content, words = DAMAGED[name]
    with pytest.raises(CaseError) as refused:
        Mesh(kind="mesh", file=text(tmp_path / name, content)).volume(SOLID)
    assert name in str(refused.value)
    assert words in str(refused.value)


@pytest.mark.parametrize("kind", ["stl", "ply", "obj", "off", "vtk", "msh"])
def test_a_file_cut_anywhere_gets_a_sentence(tmp_path, kind):
    """Or is read where nothing is missing but its last letters; never a traceback."""
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("igl")
    whole = tmp_path / f"cube.{kind}"
    if kind in ("vtk", "msh"):  # the second is Ansys'
        meshio.Mesh(CUBE, [("triangle", CUBE_FACES)]).write(whole)
    else:
        write(whole, CUBE, CUBE_FACES)
    content = whole.read_bytes()
    for end in np.linspace(1, len(content) - 3, 40).astype(int):
        part = tmp_path / f"{end}.{kind}"
        part.write_bytes(content[:end])
        with pytest.raises(CaseError, match=f"{end}.{kind}, but"):
            Mesh(kind="mesh", file=str(part)).volume(SOLID)


def test_a_truncated_binary_file_is_called_truncated(tmp_path):
    content = Path(write(tmp_path / "ball.stl", *icosphere(0.1, 1))).read_bytes()
    (tmp_path / "part.stl").write_bytes(content[:-30])
    with pytest.raises(CaseError, match=r"part\.stl, but it is truncated"):
        Mesh(kind="mesh", file=str(tmp_path / "part.stl")).volume(SOLID)


def test_cells_that_are_no_part_of_a_surface_are_refused_by_name(tmp_path):
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("igl")
    cells = [("triangle", CUBE_FACES), ("tetra", np.array([[0, 1, 2, 4]]))]
    meshio.Mesh(CUBE, cells).write(tmp_path / "solid.vtu")
    with pytest.raises(
        CaseError, match=r"solid\.vtu, but it has cells of the kind 'tetra', which are not used"
    ):
        Mesh(kind="mesh", file=str(tmp_path / "solid.vtu")).volume(SOLID)
    meshio.Mesh(CUBE, [("line", np.array([[0, 1]])), cells[0]]).write(tmp_path / "lines.vtu")
    assert Mesh(kind="mesh", file=str(tmp_path / "lines.vtu")).volume(SOLID) == pytest.approx(0.001)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_a_pipe_or_a_device_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe.stl")
    (tmp_path / "link.stl").symlink_to("/dev/zero")
    for name in ("pipe.stl", "link.stl"):
        with pytest.raises(CaseError, match=f"{name}, but that is a pipe or a device; it must be a file"):
            Mesh(kind="mesh", file=str(tmp_path / name)).volume(SOLID)


def test_a_mesh_has_a_largest_size(tmp_path):
    with open(tmp_path / "huge.stl", "wb") as file:
        file.truncate(2**30 + 1)  # a hole: it takes no room
    with pytest.raises(CaseError, match=r"huge\.stl, but it has 1 GiB; it may have at most 1 GiB"):
        Mesh(kind="mesh", file=str(tmp_path / "huge.stl")).volume(SOLID)


def test_a_part_of_a_mesh_is_exact(tmp_path):
    mesh = Mesh(kind="mesh", file=write(tmp_path / "block.ply", BLOCK_CORNERS, CUBE_FACES))
    low, high = np.array([0.013, 0.0, 0.07]), np.array([0.1, 0.13, 0.21])
    assert mesh.volume_between(low, high, SOLID) == pytest.approx(np.prod(high - low), rel=1e-6)
    part = fill(mesh, SOLID, keep=(np.array([-1, 0.03, -1]), np.ones(3)))
    assert part.volume.sum() == pytest.approx(0.1 * 0.17 * 0.3, rel=1e-6)


def test_a_rewritten_mesh_is_read_again(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = Mesh(kind="mesh", file="ball.stl")
    for number, radius in enumerate((1.0, 2.0)):
        write(tmp_path / "ball.stl", *icosphere(radius))
        os.utime("ball.stl", ns=(number, number))
        assert mesh.bounds(SOLID)[1] == pytest.approx([radius] * 3, rel=1e-6)


@pytest.mark.parametrize("library", ["igl", "trimesh"])
def test_without_its_libraries_a_mesh_says_what_to_install(tmp_path, monkeypatch, library):
    file = write(tmp_path / "ball.stl", *icosphere(1.0, 1))
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(
        CaseError, match=r"pip install libigl trimesh, or pip install '\.\[mesh\]' in a clone"
    ):
        Mesh(kind="mesh", file=file).volume(SOLID)


@pytest.mark.parametrize(
    ("shape", "space"),
    [(CONE, RADIAL), (BALL, SOLID), (BALL_2D, RADIAL), (BALL_2D, PLANE), (CONE, SOLID)],
    ids=["cone", "ball-3d", "ball", "disc", "cone-3d"],
)
def test_a_body_is_as_dense_at_its_surface_as_inside(shape, space):
    """Σ V N at nodes 0.02 m apart is the volume of the body there, also of those at a slanted or curved
    surface; a staircase of whole boxes is up to a quarter of a cell off."""
    cell = 0.02
    particles = fill(shape, space, cell)
    size = particles.volume / (2 * np.pi * particles.position[:, 0]) if space.radial else particles.volume
    lower, upper = shape.bounds(space)
    x = np.random.default_rng(3).uniform(lower, upper, (300_000 if space.dim == 2 else 4_000_000, space.dim))
    inside = x[shape.contains(x, space)]
    exact = at_nodes(inside, np.full(len(inside), np.prod(upper - lower) / len(x)), cell)
    off = (at_nodes(particles.position, size, cell) - exact) / cell**space.dim
    assert np.sqrt((off[exact > 0] ** 2).mean()) < 0.02
    assert np.abs(off).max() < 0.08


def at_nodes(position, size, cell):
    """Σ size N of the linear functions of the nodes of a block around the origin."""
    place = position / cell + 8
    first = np.floor(place).astype(int)
    part, sums = place - first, np.zeros((28,) * position.shape[1])
    for corner in np.ndindex(*(2,) * position.shape[1]):
        weight = np.where(np.array(corner) == 1, part, 1 - part).prod(axis=1)
        np.add.at(sums, tuple((first + corner).T), weight * size)
    return sums
