"""Shapes and the particles that fill them."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from mpmkit_plugins.body_shapes.box import Box
from mpmkit_plugins.body_shapes.sphere import Sphere
from pairwise import every_pair
from solids import BALL, BALL_2D, BLOCK, CONE, FUNNEL, HOPPER, PLANE, RADIAL, RING, ROD, SOLID, fill

from mpmkit.geometry import expected_count, sample

HOLLOW = Sphere(centre=[0, 0, 0.1], radius=0.1, inner_radius=0.05)
HOLLOW_2D = Sphere(centre=[0, 0.1], radius=0.1, inner_radius=0.05)

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
    ("shape", "space", "volume"), EXACT, ids=[f"{shape.name}-{space.name}" for shape, space, _ in EXACT]
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
        Box(lower=[0, 0], upper=[0.2, 0.1]),
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
    box = Box(lower=[0, 0], upper=[0.1, 0.07])
    assert len(fill(box, PLANE, 0.01, per_axis, origin=origin).volume) == 70 * per_axis**2


@pytest.mark.parametrize("origin", [0.0, -0.3, -7.77])
def test_points_on_the_surface_are_inside_whatever_the_rounding(origin):
    box = Box(lower=[0.005, 0.005], upper=[0.105, 0.075])
    assert len(fill(box, PLANE, 0.01, 1, origin=origin).volume) == 11 * 8


def test_the_seeds_cone_has_the_published_number_of_particles():
    for corner in (-0.2, -0.2025):  # the axis on a node, in the middle of a cell
        particles = sample(CONE, SOLID, origin=[corner, corner, 0], cell_size=0.005, per_axis=[2, 2, 2])
        assert len(particles.volume) == 351_860
    assert expected_count(CONE, SOLID, 0.005, [2, 2, 2]) == pytest.approx(351_860, rel=1e-4)
    assert len(fill(CONE, RADIAL, 0.005).volume) == 3_600


@pytest.mark.parametrize("shape", [CONE, ROD, BALL], ids=lambda shape: shape.name)
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
    """Without a correction factor: no slivers, no box wider than a cell, and no gaps between the faces."""
    block = Box(lower=[start] * space.dim, upper=[*[0.02 + start] * (space.dim - 1), end])
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
        found = shape.part(low, high, space)
        assert found == pytest.approx(weight[inside].sum(), abs=0.005 * volume)
    assert shape.part(lower - 1, upper + 1, space) == shape.volume(space)
    assert shape.part(upper + 1, upper + 2, space) == 0


def test_parts_of_round_bodies_are_exact():
    """A cap of a sphere, a segment of a cylinder, and a ring of a cone."""
    big = np.array([1.0, 1.0, 1.0])
    cap = BALL.part(np.array([0.04, -1, -1]), big, SOLID)
    assert cap == pytest.approx(math.pi * 0.06**2 * (0.3 - 0.06) / 3, rel=1e-10)
    segment = 0.01 * math.acos(0.4) - 0.04 * math.sqrt(0.01 - 0.04**2)
    assert ROD.part(np.array([0.04, -1, -1]), big, SOLID) == pytest.approx(0.2 * segment, rel=1e-12)
    # Above r = 0.07 the cone's wall reaches to z = 0.18.
    ring = math.pi * 0.18 / 3 * (0.01 + 0.007 + 0.0049) - math.pi * 0.0049 * 0.18
    assert CONE.part(np.array([0.07, 0]), big[:2], RADIAL) == pytest.approx(ring, rel=1e-12)


@every_pair("number, place, axis", range(len(EXACT)), [0.02, 0.036, 0.0431], [-2, -1])
def test_a_body_cut_off_centre_has_the_volume_of_what_is_left(number, place, axis):
    """A plane of symmetry along the last axis but one, or along the last."""
    shape, space, volume = EXACT[number]
    lower, upper = np.full(space.dim, -1.0), np.full(space.dim, 1.0)
    lower[axis] = place
    part = fill(shape, space, keep=(lower, upper)).volume.sum()
    assert part == pytest.approx(shape.part(lower, upper, space), rel=1e-12)
    upper[axis], lower[axis] = place, -1.0
    rest = fill(shape, space, keep=(lower, upper)).volume.sum()
    assert part + rest == pytest.approx(volume, rel=1e-9)


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
    per_axis = 500 if space.dim == 2 else 100  # 2 mm apart, and evenly: a tenth of a cell
    x = lower + (upper - lower) * (np.moveaxis(np.indices((per_axis,) * space.dim), 0, -1) + 0.5) / per_axis
    x = x.reshape(-1, space.dim)
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
