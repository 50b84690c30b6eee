"""Files of surface meshes, valid and damaged."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

import numpy as np
import pytest
from mpmkit_plugins.body_shapes.mesh import Mesh
from solids import BLOCK_QUADS, CUBE, CUBE_FACES, SOLID, icosphere, text, write

from mpmkit.errors import CaseError


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
    mesh = Mesh(file=text(tmp_path / name, GOOD[name]))
    assert mesh.volume(SOLID) == pytest.approx(0.001, rel=1e-6)
    np.testing.assert_allclose(mesh.bounds(SOLID), [[0, 0, 0], [0.1, 0.1, 0.1]], atol=1e-8)


def test_axes_of_a_ply_file_go_by_their_names(tmp_path):
    pytest.importorskip("igl")
    mesh = Mesh(file=text(tmp_path / "zyx.ply", ply(["z", "y", "x"], CUBE * [3, 2, 1])))
    np.testing.assert_allclose(mesh.bounds(SOLID)[1], [0.1, 0.2, 0.3], rtol=1e-6)


def test_relative_corners_count_from_the_face_that_names_them(tmp_path):
    pytest.importorskip("igl")
    cubes = obj(CUBE, CUBE_FACES - 9) + obj(CUBE + 1, CUBE_FACES - 9)
    mesh = Mesh(file=text(tmp_path / "two.obj", cubes))
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
    mesh = Mesh(file=text(tmp_path / "prism.obj", content))
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
def test_a_damaged_file_has_its_sentence(tmp_path, name):
    pytest.importorskip("igl")
    content, words = DAMAGED[name]
    with pytest.raises(CaseError) as refused:
        Mesh(file=text(tmp_path / name, content)).volume(SOLID)
    assert name in str(refused.value)
    assert words in str(refused.value)


@pytest.mark.parametrize("kind", ["stl", "ply", "obj", "off", "vtk", "msh"])
def test_a_file_cut_anywhere_gets_a_sentence(tmp_path, kind):
    """A file cut at any place gets a sentence, or is read if only its last letters are missing; never a
    traceback."""
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
            Mesh(file=str(part)).volume(SOLID)


def test_a_truncated_binary_file_is_called_truncated(tmp_path):
    content = Path(write(tmp_path / "ball.stl", *icosphere(0.1, 1))).read_bytes()
    (tmp_path / "part.stl").write_bytes(content[:-30])
    with pytest.raises(CaseError, match=r"part\.stl, but it is truncated"):
        Mesh(file=str(tmp_path / "part.stl")).volume(SOLID)


def test_cells_that_are_no_part_of_a_surface_are_refused_by_name(tmp_path):
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("igl")
    cells = [("triangle", CUBE_FACES), ("tetra", np.array([[0, 1, 2, 4]]))]
    meshio.Mesh(CUBE, cells).write(tmp_path / "solid.vtu")
    with pytest.raises(
        CaseError, match=r"solid\.vtu, but it has cells of the kind 'tetra', which are not used"
    ):
        Mesh(file=str(tmp_path / "solid.vtu")).volume(SOLID)
    meshio.Mesh(CUBE, [("line", np.array([[0, 1]])), cells[0]]).write(tmp_path / "lines.vtu")
    assert Mesh(file=str(tmp_path / "lines.vtu")).volume(SOLID) == pytest.approx(0.001)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_a_pipe_or_a_device_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe.stl")
    (tmp_path / "link.stl").symlink_to("/dev/zero")
    for name in ("pipe.stl", "link.stl"):
        with pytest.raises(CaseError, match=f"{name}, but that is a pipe or a device; it must be a file"):
            Mesh(file=str(tmp_path / name)).volume(SOLID)


def test_a_mesh_has_a_largest_size(tmp_path):
    with open(tmp_path / "huge.stl", "wb") as file:
        file.truncate(2**30 + 1)  # a hole: it takes no room
    with pytest.raises(CaseError, match=r"huge\.stl, but it has 1 GiB; it may have at most 1 GiB"):
        Mesh(file=str(tmp_path / "huge.stl")).volume(SOLID)


@pytest.mark.parametrize("library", ["igl", "trimesh"])
def test_without_its_libraries_a_mesh_says_what_to_install(tmp_path, monkeypatch, library):
    file = write(tmp_path / "ball.stl", *icosphere(1.0, 1))
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(
        CaseError, match=r"pip install libigl trimesh, or pip install '\.\[mesh\]' in a clone"
    ):
        Mesh(file=file).volume(SOLID)
