"""Bodies from closed surface meshes: they fill the volume inside the surface."""

from __future__ import annotations

import math
import os

import numpy as np
import pytest
from mpmkit_plugins.body_shapes.mesh import Mesh
from solids import BALL, BLOCK, BLOCK_QUADS, CUBE, CUBE_FACES, SOLID, fill, icosphere, text, write

from mpmkit.errors import CaseError


def ball(place):
    vertices, faces = icosphere(100.0)
    return Mesh(file=write(place, vertices, faces), scale=0.001, translate=[0, 0, 0.1])


def test_a_mesh_is_filled_as_the_sphere_that_it_resembles(tmp_path):
    mesh = ball(tmp_path / "ball.stl")
    particles, reference = fill(mesh, SOLID), fill(BALL, SOLID)
    assert len(particles.volume) == pytest.approx(len(reference.volume), rel=0.01)
    assert particles.volume.sum() == pytest.approx(mesh.volume(SOLID), rel=1e-12)


@pytest.mark.parametrize("name", ["ball.stl", "ball.obj", "ball.ply"])
def test_a_mesh_is_the_sphere_that_it_resembles_in_every_format(tmp_path, name):
    mesh = ball(tmp_path / name)
    assert mesh.problem(SOLID) is None
    assert mesh.volume(SOLID) == pytest.approx(BALL.volume(SOLID), rel=5e-3)
    np.testing.assert_allclose(mesh.bounds(SOLID), BALL.bounds(SOLID), atol=1e-6)
    # Lattice points in the planes of symmetry, where the icosphere has corners and edges.
    points = np.random.default_rng(2).integers(-12, 13, (2000, 3)) * 0.01 + [0, 0, 0.1]
    distance = np.linalg.norm(points - [0, 0, 0.1], axis=1)
    clear = abs(distance - 0.1) > 0.0005
    np.testing.assert_array_equal(mesh.contains(points, SOLID)[clear], (distance < 0.1)[clear])


BLOCK_CORNERS = np.array([[x, y, z] for x in (0, 0.1) for y in (0, 0.2) for z in (0, 0.3)])


@pytest.mark.parametrize("turned", [[], [0], [1, 4], range(6)])
def test_quadrilaterals_are_split_and_normals_turned(tmp_path, turned):
    pytest.importorskip("trimesh")
    lines = [f"v {x} {y} {z}" for x, y, z in BLOCK_CORNERS]
    for number, face in enumerate(BLOCK_QUADS + 1):
        lines.append("f " + " ".join(map(str, face[::-1] if number in turned else face)))
    (tmp_path / "block.obj").write_text("\n".join(lines) + "\n")
    mesh = Mesh(file=str(tmp_path / "block.obj"))
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
    mesh = Mesh(file=write(tmp_path / "hollow.stl", vertices, shells))
    ball = 4 / 3 * math.pi * 0.001
    assert mesh.volume(SOLID) == pytest.approx(ball * (1 - 1 / 8 + 1 / 64), rel=0.02)
    points = np.array([[0, 0, 0], [0.07, 0, 0], [0.5, 0, 0], [1, 0, 0]])
    assert mesh.contains(points, SOLID).tolist() == [False, True, False, True]


@pytest.mark.parametrize("far", [0.0, 1e3])
def test_a_point_on_a_meshs_surface_is_inside_and_one_just_off_it_is_not(tmp_path, far):
    trimesh = pytest.importorskip("trimesh")
    file = write(tmp_path / "ball.ply", *icosphere(1.0, 3))
    mesh = Mesh(file=file, translate=[far, far, far])
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
            Mesh(file=file).volume(SOLID)
        assert file in str(refused.value)


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
    mesh = Mesh(file=write(tmp_path / "cubes.ply", *surface), scale=scale)
    with pytest.raises(
        CaseError, match=r"cubes\.ply, but its surface crosses itself, or shells of it overlap, near"
    ):
        mesh.volume(SOLID)


def test_a_surface_that_crosses_itself_is_refused(tmp_path):
    """A block of which one end is turned over: its walls cross half way."""
    corners = BLOCK_CORNERS.copy()
    corners[[1, 3, 5, 7]] = corners[[3, 1, 7, 5]]
    mesh = Mesh(file=write(tmp_path / "bow.ply", corners, CUBE_FACES))
    with pytest.raises(CaseError, match="crosses itself"):
        mesh.volume(SOLID)
    corners[[1, 5], 1] *= 1.5  # so that the two halves do not cancel
    mesh = Mesh(file=write(tmp_path / "bow_tie.ply", corners, CUBE_FACES))
    with pytest.raises(CaseError, match="crosses itself"):
        mesh.volume(SOLID)


@pytest.mark.parametrize("shift", [[0.1, 0.03, 0.02], [0.1001, 0, 0], [0.3, 0, 0]])
def test_shells_that_touch_or_stand_apart_are_added(tmp_path, shift):
    file = write(tmp_path / "cubes.ply", *shells((1, [0, 0, 0]), (1, shift)))
    assert Mesh(file=file).volume(SOLID) == pytest.approx(0.002, rel=1e-6)


def test_a_part_of_a_mesh_is_exact(tmp_path):
    mesh = Mesh(file=write(tmp_path / "block.ply", BLOCK_CORNERS, CUBE_FACES))
    low, high = np.array([0.013, 0.0, 0.07]), np.array([0.1, 0.13, 0.21])
    assert mesh.volume_between(low, high, SOLID) == pytest.approx(np.prod(high - low), rel=1e-6)
    part = fill(mesh, SOLID, keep=(np.array([-1, 0.03, -1]), np.ones(3)))
    assert part.volume.sum() == pytest.approx(0.1 * 0.17 * 0.3, rel=1e-6)


def test_a_rewritten_mesh_is_read_again(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = Mesh(file="ball.stl")
    for number, radius in enumerate((1.0, 2.0)):
        write(tmp_path / "ball.stl", *icosphere(radius))
        os.utime("ball.stl", ns=(number, number))
        assert mesh.bounds(SOLID)[1] == pytest.approx([radius] * 3, rel=1e-6)
