"""Distances of shapes and shells against closed forms and against the nearest of many points."""

import math

import numpy as np
import pytest
from mpmkit_plugins.body_shapes.box import Box
from mpmkit_plugins.body_shapes.cylinder import Cylinder
from mpmkit_plugins.body_shapes.frustum import Frustum
from mpmkit_plugins.body_shapes.mesh import Mesh
from mpmkit_plugins.body_shapes.polygon import Polygon
from mpmkit_plugins.body_shapes.sphere import Sphere

from mpmkit.geometry import Inverted
from mpmkit.spaces import SPACES

FRUSTUM = Frustum(bottom_radius=0.1, top_radius=0.05, height=0.3)
CONE = Frustum(bottom_radius=0.0, top_radius=0.1, height=0.2)
CYLINDER = Cylinder(radius=0.1, height=0.2)
BOX = Box(lower=[0.0, -0.1], upper=[0.2, 0.1])
BOX_3D = Box(lower=[0.0, -0.1, 0.0], upper=[0.2, 0.1, 0.3])
TRIANGLE = Polygon(corners=[[0, 0], [0.3, 0], [0, 0.4]])
PRISM = Polygon(corners=TRIANGLE.corners, y=[0.0, 0.2])
FLAT, ROUND, SOLID = SPACES["plane-strain"], SPACES["axisymmetric"], SPACES["3d"]
SLANT = math.hypot(0.3, 0.05)
T = 0.02


def at(solid, *points):
    distance, gradient = solid.distance(np.array(points, dtype=float))
    return distance, gradient


# --- Closed forms -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shape", "space", "point", "distance", "gradient"),
    [
        (FRUSTUM, ROUND, [0.075, 0.15], 0.0, [0.3, 0.05]),  # on the slanted side
        (FRUSTUM, ROUND, [0.0, 0.04], -0.04, [0, -1]),  # the bottom is nearest
        (FRUSTUM, ROUND, [0.13, -0.04], 0.05, [3, -4]),  # its lower edge
        (FRUSTUM, ROUND, [0.08, 0.34], 0.05, [3, 4]),  # its upper edge
        (FRUSTUM, FLAT, [-0.13, -0.04], 0.05, [-3, -4]),
        (FRUSTUM, SOLID, [0.09, 0.12, 0.15], 0.075 * 0.3 / SLANT, [0.6 * 0.3, 0.8 * 0.3, 0.05]),
        (CYLINDER, SOLID, [0.0, -0.13, 0.24], 0.05, [0, -3, 4]),
        (CYLINDER, SOLID, [0.06, 0.0, 0.1], -0.04, [1, 0, 0]),
        (CONE, ROUND, [0.0, -0.05], 0.05, [0, -1]),  # its tip
        (BOX, ROUND, [0.0, 0.07], -0.03, [0, 1]),  # the axis is inside, and no face
        (BOX, ROUND, [0.19, 0.0], -0.01, [1, 0]),
        (BOX, FLAT, [0.01, 0.0], -0.01, [-1, 0]),
        (BOX_3D, SOLID, [0.22, 0.11, 0.32], 0.03, [2, 1, 2]),  # its corner
        (Sphere(centre=[0, 0.1], radius=0.1), ROUND, [0.12, 0.26], 0.1, [3, 4]),
        (Sphere(centre=[0, 0], radius=0.1, inner_radius=0.04), FLAT, [0.03, 0], 0.01, [-1, 0]),
        (
            Sphere(centre=[0, 0], radius=0.1, inner_radius=0.04),
            FLAT,
            [0.06, 0],
            -0.02,
            [-1, 0],
        ),
        (TRIANGLE, FLAT, [0.23, 0.26], 0.1, [4, 3]),
        (TRIANGLE, FLAT, [0.04, 0.2], -0.04, [-1, 0]),
        (TRIANGLE, ROUND, [0.0, 0.02], -0.02, [0, -1]),  # the axis is inside, and no face
        (PRISM, SOLID, [0.23, 0.1, 0.26], 0.1, [4, 0, 3]),
        (PRISM, SOLID, [0.1, 0.19, 0.1], -0.01, [0, 1, 0]),
        (PRISM, SOLID, [0.12 + 0.03 * 0.8, -0.04, 0.24 + 0.03 * 0.6], 0.05, [0.6 * 0.8, -0.8, 0.6 * 0.6]),
    ],
)
def test_distance_and_direction(shape, space, point, distance, gradient):
    found, direction = at(shape.solid(space), point)
    assert found[0] == pytest.approx(distance, abs=1e-15)
    np.testing.assert_allclose(direction[0], np.array(gradient) / np.linalg.norm(gradient), atol=1e-14)


@pytest.mark.parametrize(
    ("point", "distance", "gradient"),
    [
        ([0.075, 0.15], 0.0, [-0.3, -0.05]),  # its inner surface is that of the shape, and points inwards
        ([0.0, 0.15], 0.075 * 0.3 / SLANT, [-0.3, -0.05]),
        ([0.075 + T * SLANT / 0.3, 0.15], 0.0, [0.3, 0.05]),  # it is as thick as it says, along the normal
        ([0.075 + T * SLANT / 0.6, 0.15], -T / 2, None),
        ([0.105, -0.03], 0.03, [0, -1]),  # the rim is flat, and stands on the floor
        ([0.06, 0.33], 0.03, [0, 1]),
        ([0.0, -0.03], math.hypot(0.1, 0.03), [-0.1, -0.03]),  # no floor: the inner edge is nearest
        ([0.0, 0.40], math.hypot(0.05, 0.1), [-0.05, 0.1]),  # and no lid
    ],
)
@pytest.mark.parametrize("space", [FLAT, ROUND, SOLID], ids=lambda space: space.name)
def test_a_mould_is_open_at_both_ends(point, distance, gradient, space):
    wide = (lambda v: [v[0], 0.0, v[1]]) if space.dim == 3 else list
    found, direction = at(FRUSTUM.shell(space, T, FRUSTUM.ends_left_open(space)), wide(point))
    assert found[0] == pytest.approx(distance, abs=1e-15)
    if gradient is not None:
        np.testing.assert_allclose(direction[0], wide(np.array(gradient) / np.hypot(*gradient)), atol=1e-12)


def test_the_ends_of_a_shell():
    below, above = [0.0, -0.01], [0.0, 0.21]
    for ends, in_plates in (([], [True, True]), (["top"], [True, False]), (["bottom"], [False, True])):
        found, _ = at(CYLINDER.shell(ROUND, T, ends), below, above)
        assert (found < 0).tolist() == in_plates
        assert found[np.array(in_plates)] == pytest.approx(-0.01)
    trough = BOX.shell(FLAT, T, ["z_max"])
    found, _ = at(trough, [0.1, 0.11], [0.1, -0.11], [-0.01, 0.0], [-0.01, 0.11], [0.1, 0.05])
    assert found.tolist() == pytest.approx([math.hypot(0.1, 0.01), -0.01, -0.01, 0.01, 0.1])
    assert CYLINDER.ends(SOLID) == ("bottom", "top")
    assert CONE.ends(SOLID) == CONE.ends_left_open(SOLID) == ("top",)
    assert BOX.ends(ROUND) == ("r_max", "z_min", "z_max")
    assert BOX.ends_left_open(FLAT) == ()


# --- Parts -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shape", "ends", "counts"),
    [
        (FRUSTUM, None, (4, 3, 3)),  # a container: a plane or a cone for each face
        (CONE, None, (3, 2, 2)),  # its tip is no face
        (CYLINDER, None, (4, 3, 3)),
        (FRUSTUM, ["top"], (2, 2, 2)),  # a cup: its side and its bottom
        (FRUSTUM, [], (3, 3, 3)),
        (FRUSTUM, ["bottom", "top"], (1, 1, 1)),
        (CONE, ["top"], (1, 1, 1)),
        (BOX, None, (4, 3, None)),
        (BOX, ["x_min"], (3, None, None)),
        (BOX_3D, None, (None, None, 6)),
        (BOX_3D, ["z_max"], (None, None, 5)),
    ],
)
def test_parts_are_together_the_wall(shape, ends, counts):
    """φ of the whole is the least φ of its parts where material may be, and nowhere is a part in its way."""
    for space, count in zip((FLAT, ROUND, SOLID), counts, strict=True):
        if count is None:
            continue
        whole = Inverted(shape.solid(space)) if ends is None else shape.shell(space, T, ends)
        parts = whole.parts(space.radial)
        assert len(parts) == count
        x = np.random.default_rng(4).uniform(-0.3, 0.4, (4000, space.dim))
        if space.radial:
            x[:, 0] = np.abs(x[:, 0])
        found, least = whole.distance(x)[0], np.min([part.distance(x)[0] for part in parts], axis=0)
        np.testing.assert_allclose(least[found > 0], found[found > 0], atol=1e-14)
        assert (least[found < 0] < 0).all()


# --- Against the nearest of many points -------------------------------------------------------------------


def boundary(solid, extent, dim, seed):
    """Points of the surface: many points, moved to it along the gradient."""
    x = np.random.default_rng(seed).uniform(-extent, extent, (40_000, dim))
    distance, gradient = solid.distance(x)
    return x - distance[:, None] * gradient


@pytest.mark.parametrize(
    ("shape", "ends"),
    [
        (FRUSTUM, ["bottom", "top"]),
        (FRUSTUM, []),
        (CONE, ["top"]),
        (CYLINDER, ["bottom"]),
        (BOX, ["x_min", "z_max"]),
        (BOX, []),
    ],
)
def test_no_point_of_the_surface_is_nearer(shape, ends):
    """In plane strain, where a surface is sampled densely: from outside and from within the shell."""
    solid = shape.shell(FLAT, T, ends)
    surface = boundary(solid, 0.4, 2, 1)
    assert np.abs(solid.distance(surface)[0]).max() < 1e-15
    x = np.random.default_rng(2).uniform(-0.35, 0.35, (300, 2))
    nearest = np.array([np.sqrt(((point - surface) ** 2).sum(axis=1).min()) for point in x])
    found = np.abs(solid.distance(x)[0])
    assert (nearest >= found - 1e-15).all()
    assert (nearest - found).max() < 2e-3  # as dense as the points are


@pytest.mark.parametrize("shape", [FRUSTUM, CONE, CYLINDER])
def test_a_body_of_revolution_is_its_section_turned(shape):
    x = np.random.default_rng(3).uniform(-0.3, 0.4, (500, 3))
    turned, direction = shape.shell(SOLID, T, shape.ends_left_open(SOLID)).distance(x)
    radius = np.hypot(x[:, 0], x[:, 1])
    section, in_plane = shape.shell(ROUND, T, shape.ends_left_open(ROUND)).distance(
        np.column_stack([radius, x[:, 2]])
    )
    np.testing.assert_allclose(turned, section, rtol=0, atol=1e-15)
    np.testing.assert_allclose((direction[:, :2] * x[:, :2]).sum(axis=1) / radius, in_plane[:, 0], atol=1e-12)


def test_inside_is_the_other_sign():
    x = np.random.default_rng(4).uniform(-0.3, 0.4, (50, 2))
    distance, gradient = CYLINDER.solid(ROUND).distance(x)
    other, turned = Inverted(CYLINDER.solid(ROUND)).distance(x)
    np.testing.assert_array_equal(-distance, other)
    np.testing.assert_array_equal(-gradient, turned)


# --- Meshes -----------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def box_mesh(tmp_path_factory):
    import trimesh

    file = tmp_path_factory.mktemp("mesh") / "box.stl"
    made = trimesh.creation.box(extents=(0.2, 0.2, 0.3)).subdivide()
    made.apply_translation((0.1, 0.0, 0.15))
    made.export(file)
    return Mesh(file=str(file))


def test_a_mesh_of_a_box_is_the_box(box_mesh):
    x = np.random.default_rng(5).uniform(-0.3, 0.5, (3000, 3))
    distance, gradient = BOX_3D.solid(SOLID).distance(x)
    found, direction = box_mesh.solid(SOLID).distance(x)
    np.testing.assert_allclose(found, distance, rtol=0, atol=2e-8)  # an STL file is in single precision
    assert (np.abs(direction - gradient).max(axis=1) < 1e-4).mean() > 0.999  # but where two faces are as near


def test_a_shell_of_a_mesh(box_mesh):
    shell = box_mesh.shell(SOLID, T, box_mesh.ends_left_open(SOLID))
    found, _ = at(shell, [0.1, 0, 0.01], [0.1, 0, -0.01], [0.1, 0, -0.05], [0.1, 0, 0.0])
    assert found.tolist() == pytest.approx([0.01, -0.01, 0.03, 0.0], abs=1e-8)
    assert box_mesh.ends(SOLID) == ()


def test_sharp_edges_of_a_mesh_keep_their_sign():
    """Near the edge of a blade of 2°, the normal of the nearest face alone may say the wrong side."""
    import igl

    from mpmkit.geometry.distance.surface_mesh import SurfaceMesh

    vertices = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0.02, 0], [0.5, 0.01, 1.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    rng = np.random.default_rng(6)
    x = np.concatenate([rng.uniform(-1, 2, (2000, 3)), rng.uniform([0, 0, 0], [1, 0.02, 1], (4000, 3))])
    distance, gradient = SurfaceMesh(vertices, faces).distance(x)
    inside = igl.winding_number(vertices, faces, x) > 0.5
    np.testing.assert_array_equal(distance < 0, inside)
    assert 100 < inside.sum() < 3000
    on_it = x - distance[:, None] * gradient
    assert np.abs(SurfaceMesh(vertices, faces).distance(on_it)[0]).max() < 1e-13
