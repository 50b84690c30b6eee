"""The drawn surface of a wall, where its distance is zero, in two and three dimensions."""

import numpy as np
import pytest
from mpmkit_plugins.body_shapes.box import Box
from mpmkit_plugins.body_shapes.cylinder import Cylinder
from mpmkit_plugins.body_shapes.frustum import Frustum
from mpmkit_plugins.body_shapes.sphere import Sphere

from mpmkit.contracts.solid import Shell
from mpmkit.geometry import HalfSpace, Inverted, contour
from mpmkit.spaces import SPACES

PLANE, SOLID = SPACES["plane-strain"], SPACES["3d"]


def size(points, parts):
    """Length of the segments, or area of the triangles."""
    corners = points[parts]
    if points.shape[1] == 2:
        return np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1).sum()
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.linalg.norm(np.cross(a, b), axis=1).sum() / 2


def open_ends(points, parts):
    """Ends of segments, or edges of triangles, that belong to one of them only."""
    dim = points.shape[1]
    edges = np.concatenate([np.delete(parts, k, axis=1) for k in range(dim)])
    _, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    return int((count == 1).sum())


def test_a_disc_is_a_closed_line_on_its_circle():
    disc = Sphere(centre=[0.1, 0.2], radius=0.3).solid(PLANE)
    points, parts = contour(disc.distance, np.array([-0.5, -0.5]), np.array([0.7, 0.8]), 0.01)
    np.testing.assert_allclose(np.linalg.norm(points - [0.1, 0.2], axis=1), 0.3, rtol=1e-12)
    assert size(points, parts) == pytest.approx(2 * np.pi * 0.3, rel=1e-3)
    assert open_ends(points, parts) == 0


def test_a_plane_ends_at_the_box_and_may_lie_on_its_cells():
    for height in (0.25, 0.2501):
        plane = HalfSpace(np.array([0.0, 0.0, height]), np.array([0.0, 0.0, 1.0]))
        points, parts = contour(plane.distance, np.zeros(3), np.array([1.0, 0.5, 1.0]), 0.125)
        np.testing.assert_allclose(points[:, 2], height, rtol=1e-12)
        assert size(points, parts) == pytest.approx(0.5, rel=1e-9)


@pytest.mark.parametrize("turned", [False, True], ids=["solid", "inverted"])
def test_a_ball_is_closed_from_either_side(turned):
    ball = Sphere(centre=[0.0, 0.0, 0.0], radius=0.3).solid(SOLID)
    points, parts = contour(
        (Inverted(ball) if turned else ball).distance, np.full(3, -0.4), np.full(3, 0.41), 0.03
    )
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 0.3, rtol=1e-12)
    assert size(points, parts) == pytest.approx(4 * np.pi * 0.09, rel=5e-3)
    assert open_ends(points, parts) == 0


def test_a_shell_a_cell_thick_shows_both_sides_and_its_open_ends():
    cone = Frustum(bottom_radius=0.1, top_radius=0.05, height=0.3, base=[0.0, 0.0, 0.0])
    shell = cone.shell(SOLID, 0.02, cone.ends(SOLID))
    points, parts = contour(shell.distance, np.array([-0.2, -0.2, -0.02]), np.array([0.2, 0.2, 0.32]), 0.01)
    assert np.abs(shell.distance(points)[0]).max() < 1e-12
    slant, out = np.hypot(0.3, 0.05), 0.02 * np.hypot(1, 0.05 / 0.3)
    rims = np.pi * ((0.1 + out) ** 2 - 0.1**2 + (0.05 + out) ** 2 - 0.05**2)
    exact = np.pi * 0.15 * slant + np.pi * (0.15 + 2 * out) * slant + rims
    assert size(points, parts) == pytest.approx(exact, rel=0.03)  # less what its edges are cut off
    assert open_ends(points, parts) == 0
    radius = np.linalg.norm(points[:, :2], axis=1)
    middle = np.abs(points[:, 2] - 0.15) < 0.02
    assert set(np.round(radius[middle] - 0.1 + points[middle, 2] / 6, 2)) == {0.0, 0.02}


def test_an_edge_is_cut_off_by_less_than_a_cell():
    box = Box(lower=[0.0, 0.0], upper=[0.3, 0.2]).solid(PLANE)
    points, parts = contour(box.distance, np.array([-0.113, -0.1]), np.array([0.4, 0.31]), 0.005)
    assert size(points, parts) == pytest.approx(1.0, abs=4 * 0.6 * 0.005)
    for corner in ([0, 0], [0.3, 0], [0.3, 0.2], [0, 0.2]):
        assert np.linalg.norm(points - corner, axis=1).min() < 0.005


def test_a_cylinder_of_another_spacing_along_each_axis():
    rod = Cylinder(radius=0.1, height=0.4, base=[0.0, 0.0, 0.0]).solid(SOLID)
    points, parts = contour(rod.distance, np.array([-0.2, -0.13, -0.1]), np.array([0.2, 0.13, 0.6]), 0.01)
    assert size(points, parts) == pytest.approx(2 * np.pi * 0.1 * 0.5, rel=0.02)
    assert open_ends(points, parts) == 0


def test_what_is_outside_the_box_is_not_drawn():
    disc = Sphere(centre=[5.0, 5.0], radius=0.3).solid(PLANE)

    def distance(x):
        assert len(x)  # a third party's surface need not bear to be asked of no points
        return disc.distance(x)

    points, parts = contour(distance, np.zeros(2), np.ones(2), 0.01)
    assert (points.shape, parts.shape) == ((0, 2), (0, 2))


def test_a_large_surface_is_drawn_more_coarsely():
    ball = Sphere(centre=[0.0, 0.0, 0.0], radius=1.0).solid(SOLID)
    points, parts = contour(Shell(ball, 0.1).distance, np.full(3, -1.2), np.full(3, 1.2), 0.005)
    assert len(parts) < 300_000
    assert size(points, parts) == pytest.approx(4 * np.pi * (1 + 1.1**2), rel=0.01)
