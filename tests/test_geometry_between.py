"""Bodies that touch or overlap, and shapes that are refused."""

from __future__ import annotations

import math

import pytest
from mpmkit_plugins.body_shapes.box import Box
from mpmkit_plugins.body_shapes.cylinder import Cylinder
from mpmkit_plugins.body_shapes.mesh import Mesh
from mpmkit_plugins.body_shapes.polygon import Polygon
from mpmkit_plugins.body_shapes.sphere import Sphere
from pydantic import ValidationError
from solids import BALL, BALL_2D, BLOCK, CONE, FUNNEL, HOPPER, PLANE, RADIAL, RING, ROD, SOLID, fill, whole

from mpmkit.errors import CaseError
from mpmkit.geometry import expected_count, shared_volume
from mpmkit.registry import installed

TOUCHING = {
    "on a row of lattice points": (
        Box(lower=[0, 0], upper=[0.305, 0.2]),
        Box(lower=[0.305, 0], upper=[0.5, 0.2]),
        PLANE,
    ),
    "discs in a lattice point": (
        BALL_2D,
        Sphere(centre=[0.2, 0.1], radius=0.1),
        PLANE,
    ),
    "a cone under a rod": (CONE, ROD.model_copy(update={"base": [0.0, 0.0, 0.3]}), SOLID),
    "a ball on a block": (BALL, Box(lower=[-0.1, -0.1, -0.1], upper=[0.1, 0.1, 0.0]), SOLID),
    "side by side, bounds within each other": (
        Sphere(centre=[0.0, 0.0], radius=0.1),
        Sphere(centre=[0.12, 0.16], radius=0.1),
        PLANE,
    ),
}


SHAPES = installed().of_kind("body_shape")


@pytest.mark.parametrize("touching", TOUCHING.values(), ids=TOUCHING)
def test_bodies_that_touch_share_no_volume(touching):
    first, second, space = touching
    for a, b in ((first, second), (second, first)):
        assert shared_volume(a, b, space, [0.01] * space.dim, whole(space)) == 0


def test_an_overlap_thinner_than_a_particle_is_measured():
    low, high = (Box(lower=[0, z], upper=[0.2, end]) for z, end in ((0, 0.2), (0.196, 0.3)))
    found = shared_volume(low, high, PLANE, [0.01, 0.01], whole(PLANE))
    assert found == pytest.approx(0.2 * 0.004, rel=1e-12)
    assert shared_volume(low, high, PLANE, [0.01, 0.01], ([-1, -1], [0, 1])) == 0  # outside the domain
    disc = Cylinder(radius=0.1, height=0.1, base=[0, 0, 0.196])
    found = shared_volume(ROD, disc, SOLID, [0.01] * 3, whole(SOLID))
    assert found == pytest.approx(math.pi * 0.01 * 0.004, rel=0.02)
    lens = Sphere(centre=[0.0, 0.298], radius=0.1)
    exact = 2 * math.pi * 0.001**2 * (0.3 - 0.001) / 3
    assert shared_volume(BALL_2D, lens, RADIAL, [0.01] * 2, whole(RADIAL)) == pytest.approx(exact, rel=0.1)


def test_a_body_between_lattice_points_gets_no_particles():
    crumb = Sphere(centre=[0.5, 0.5, 0.5], radius=0.01)
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
        (Sphere(centre=[0.1, 0], radius=1), RADIAL, ["centre", "[0.1, 0.0]", "[0, z]"]),
        (ROD.model_copy(update={"base": [0.2, 0.0]}), RADIAL, ["cylinder's base", "[0.2, 0.0]", "[0, z]"]),
        (CONE.model_copy(update={"base": [0.0, 0.0]}), SOLID, ["frustum's base", "3 numbers"]),
        (Box(lower=[-1, 0], upper=[1, 1]), RADIAL, ["lower", "[-1.0, 0.0]", "at least 0"]),
        (FUNNEL, SOLID, ["y is None", "3d", "needs y"]),
        (HOPPER, PLANE, ["y is [-0.1, 0.05]", "has no y"]),
        (Polygon(corners=[[-1, 0], [1, 0], [0, 1]]), RADIAL, ["[-1.0, 0.0]", "at least 0"]),
        (Mesh(file="a.stl"), PLANE, ["a.stl", "only in 3d"]),
        (Mesh(file="nowhere.stl"), SOLID, ["nowhere.stl", "no such file"]),
    ],
)
def test_a_shape_that_the_space_cannot_hold_is_refused(shape, space, words):
    with pytest.raises(CaseError, match=shape.name) as used:
        fill(shape, space)
    assert shape.problem(space) == str(used.value)
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
    ],
)
def test_nonsense_is_refused(bad):
    with pytest.raises(ValidationError):
        SHAPES[bad["kind"]].model_validate(bad)


@pytest.mark.parametrize("shape", [CONE, ROD, BALL, BLOCK, Mesh(file="a.stl")])
def test_shapes_survive_json(shape):
    assert type(shape).model_validate_json(shape.model_dump_json()) == shape
