"""The run directory of a case with a mesh is complete: it can be moved, and the original mesh can be
deleted."""

from __future__ import annotations

import errno
import json
import os
import shutil
from pathlib import Path

import pytest
import xarray
from mpmkit_plugins.body_shapes.mesh import Mesh
from studies import Now

import mpmkit
from mpmkit.case import load_case, parse_case
from mpmkit.cli import main
from mpmkit.errors import CaseError, OutputError
from mpmkit.geometry import sample
from mpmkit.report import write_report
from mpmkit.running.case_files import named_files, portable
from mpmkit.running.runner import resume
from mpmkit.solver.simulation import Simulation
from mpmkit.spaces import SPACES
from mpmkit.study import execute, load_study, members_of
from mpmkit.study.store import Store

meshio = pytest.importorskip("meshio")
trimesh = pytest.importorskip("trimesh")

MATERIAL = {"law": "newtonian", "density": 1000.0, "viscosity": 5.0, "sound_speed": 10.0}


def ball(path: Path, radius=0.1, centre=(0.0, 0.0, 0.15), subdivisions=2) -> str:
    """A mesh file whose corners have no short decimals."""
    made = trimesh.creation.icosphere(subdivisions, radius=radius)
    path.parent.mkdir(parents=True, exist_ok=True)
    trimesh.Trimesh(made.vertices + centre, made.faces, process=False).export(path)
    return str(path)


def scene(*files: str, **changes) -> dict:
    return {
        "name": "drops",
        "space": "3d",
        "until": 0.02,
        "grid": {
            "cell_size": 0.05,
            "domain": {"x": [-0.2, 0.6], "y": [-0.2, 0.2], "z": [0, 0.3]},
            "faces": {"z_min": "slip"},
        },
        "bodies": [
            {
                "shape": {"kind": "mesh", "file": file, "translate": [0.3 * number, 0.0, 0.0]},
                "material": MATERIAL,
            }
            for number, file in enumerate(files)
        ],
        "output": {"report": False, "particle_history": ["position", "velocity"]},
    } | changes


def status(*arguments) -> int:
    with pytest.raises(SystemExit) as ended:
        main([str(argument) for argument in arguments])
    return ended.value.code


def same_bits(a: Path, b: Path):
    with xarray.open_dataset(a / "history.nc") as one, xarray.open_dataset(b / "history.nc") as other:
        xarray.testing.assert_identical(one.drop_attrs(), other.drop_attrs())
        assert one.attrs["case"] == other.attrs["case"]


def files_in(directory: Path) -> list[str]:
    return sorted(path.name for path in directory.iterdir())


def crash_after(monkeypatch, seconds: float):
    advance = Simulation.advance

    def advanced(self, *arguments):
        if self.time > seconds:
            raise MemoryError("the machine has gone")
        return advance(self, *arguments)

    monkeypatch.setattr(Simulation, "advance", advanced)


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    """A folder with the directories of a run that came to its end, ``whole``, and of one that died; the mesh
    of both has been moved to ``elsewhere``."""
    folder = tmp_path_factory.mktemp("made")
    file = ball(folder / "cad" / "ball.stl")
    mpmkit.run(parse_case(scene(file)), folder / "whole", threads=1)
    with pytest.MonkeyPatch.context() as patched:
        crash_after(patched, 0.01)
        with pytest.raises(MemoryError):
            mpmkit.run(parse_case(scene(file)), folder / "died", threads=1, checkpoint_every=1e-9)
    shutil.move(folder / "cad", folder / "elsewhere")
    return folder


@pytest.fixture
def finished(made, tmp_path) -> Path:
    """A run directory at another place than where it was made, whose mesh is gone: a copy for each test."""
    return Path(shutil.copytree(made / "whole", tmp_path / "run"))


@pytest.fixture
def stopped(made, tmp_path) -> Path:
    """The same of the run that died, beside ``whole`` and ``elsewhere``."""
    for name in ("whole", "elsewhere"):
        shutil.copytree(made / name, tmp_path / name)
    return Path(shutil.copytree(made / "died", tmp_path / "run"))


# --- The copy


def quads(path: Path):
    """A block of quadrilaterals, two of them the other way round."""
    corners = [(x, y, z) for x in (0.0, 0.1) for y in (0.0, 0.2) for z in (0.1 / 3, 0.3)]
    faces = [[0, 1, 3, 2], [5, 7, 6, 4], [0, 4, 5, 1], [2, 3, 7, 6], [4, 6, 2, 0], [1, 5, 7, 3]]
    path.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in corners) + "".join(
        "f " + " ".join(str(corner + 1) for corner in face) + "\n" for face in faces))  # fmt: skip


def with_a_side_file(path: Path):
    """Abaqus' format, with the mesh itself in a file that is included."""
    ball(path.with_suffix(".ply"))
    part = path.with_name("part.inp")
    meshio.write(part, meshio.read(path.with_suffix(".ply")))
    path.write_text(f"*INCLUDE, INPUT={part.name}\n")


@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("ball.stl", ball),
        ("ball.obj", ball),
        ("ball.ply", ball),
        ("ball.off", ball),
        ("block.obj", quads),
        ("ball.inp", with_a_side_file),
    ],
)
def test_a_copy_gives_the_same_particles_to_the_bit_and_needs_no_other_file(
    tmp_path, monkeypatch, name, write
):
    monkeypatch.chdir(tmp_path)
    write(tmp_path / name)
    original = Mesh(file=name, scale=0.9, translate=[0.01, 0.0, 0.0])
    (tmp_path / "copies").mkdir()
    copy = tmp_path / "copies" / original.content_name("file")
    copy.write_bytes(original.content("file"))
    copied = original.model_copy(update={"file": str(copy)})

    def filled(mesh):
        return sample(mesh, SPACES["3d"], origin=[0.0] * 3, cell_size=0.02, per_axis=[2] * 3)

    before = filled(original)
    for path in tmp_path.glob("*.*"):
        path.unlink()
    after = filled(copied)
    assert len(before.volume) > 1000
    for field in ("position", "half_size", "volume"):
        assert getattr(before, field).tobytes() == getattr(after, field).tobytes(), field
    assert (copied.content_name("file"), copied.content("file")) == (copy.name, copy.read_bytes())


def test_meshes_of_one_name_do_not_collide_and_one_that_is_named_twice_is_there_once(tmp_path):
    small, large = ball(tmp_path / "a" / "ball.stl", 0.08), ball(tmp_path / "b" / "ball.stl", 0.1)
    mpmkit.run(parse_case(scene(small, large)), tmp_path / "two", threads=1)
    mpmkit.run(parse_case(scene(small, small)), tmp_path / "one", threads=1)
    assert len(files_in(tmp_path / "two" / "meshes")) == 2
    assert len(files_in(tmp_path / "one" / "meshes")) == 1
    shutil.rmtree(tmp_path / "a")
    shutil.rmtree(tmp_path / "b")
    for name in ("one", "two"):
        assert status("rerun", tmp_path / name, "--quiet") == 0


def test_without_a_mesh_there_is_no_such_directory(tmp_path):
    sphere = {"kind": "sphere", "centre": [0.0, 0.0, 0.15], "radius": 0.1}
    mpmkit.run(parse_case(scene(bodies=[{"shape": sphere, "material": MATERIAL}])), tmp_path / "run")
    assert not (tmp_path / "run" / "meshes").exists()


# --- The directory alone


def test_a_run_is_repeated_where_the_mesh_is_gone_and_the_directory_was_moved(
    finished, tmp_path, monkeypatch, capsys
):
    (tmp_path / "cwd").mkdir()
    monkeypatch.chdir(tmp_path / "cwd")
    assert status("rerun", Path("..") / "run", "--quiet") == 0
    assert "the same bits" in capsys.readouterr().out
    again = tmp_path / "run-rerun"
    same_bits(finished, again)
    assert (again / "case.json").read_text() == (finished / "case.json").read_text()
    assert files_in(again / "meshes") == files_in(finished / "meshes")
    assert "cad" not in (finished / "case.json").read_text()
    write_report(finished)
    assert list((finished / "report").glob("*.png"))


def test_its_case_file_is_one_like_any_other(finished, tmp_path, monkeypatch):
    (tmp_path / "cwd").mkdir()
    monkeypatch.chdir(tmp_path / "cwd")
    assert status("run", "../run/case.json", "--out", "again", "--quiet") == 0
    same_bits(finished, tmp_path / "cwd" / "again")


def test_a_run_that_died_goes_on_without_the_mesh(stopped, tmp_path, monkeypatch):
    (tmp_path / "cwd").mkdir()
    monkeypatch.chdir(tmp_path / "cwd")
    assert status("run", "--resume", "../run", "--quiet", "--threads", 1) == 0
    same_bits(stopped, tmp_path / "whole")


def test_the_case_as_the_user_has_it_is_the_same_one_wherever_the_mesh_lies(stopped, tmp_path):
    resume(stopped, case=parse_case(scene(str(tmp_path / "elsewhere" / "ball.stl"))), threads=1)
    same_bits(stopped, tmp_path / "whole")


# --- Another mesh


def test_another_mesh_is_refused_by_its_name(stopped, tmp_path):
    other = ball(tmp_path / "elsewhere" / "ball.stl", 0.09)
    with pytest.raises(CaseError, match=r"bodies\.0\.shape\.file is '.*ball\.stl', which holds something"):
        resume(stopped, case=parse_case(scene(other)))
    data = json.loads((stopped / "case.json").read_text())
    data["bodies"][0]["shape"]["file"] = other
    (stopped / "case.json").write_text(json.dumps(data))
    with pytest.raises(CaseError, match=r"cannot go on.*case\.bodies\.0\.shape\.file is '.*ball\.stl'"):
        resume(stopped)


@pytest.mark.parametrize("how", ["another ball", "outside the domain", "no mesh", "gone"])
def test_a_copy_that_was_changed_is_refused_by_its_name(stopped, how, capsys):
    (copy,) = (stopped / "meshes").iterdir()
    if how == "another ball":
        ball(copy, 0.1001)
    elif how == "outside the domain":
        ball(copy, 5.0)
    elif how == "no mesh":
        copy.write_bytes(b"words")
    else:
        copy.unlink()
    before = {path: path.read_bytes() for path in stopped.rglob("*") if path.is_file()}
    for command in (["run", "--resume"], ["rerun"]):
        assert status(*command, stopped, "--quiet") == 2
        said = capsys.readouterr().err
        assert copy.name in said
        assert said.count("\n") == 1
        assert ("there is no such file" if how == "gone" else "its content has changed") in said
    assert {path: path.read_bytes() for path in stopped.rglob("*") if path.is_file()} == before
    assert not stopped.with_name("run-rerun").exists()


def test_a_run_needs_the_mesh_no_longer_once_it_has_begun(tmp_path, monkeypatch):
    file = ball(tmp_path / "ball.stl")
    advance = Simulation.advance

    def advanced(self, *arguments):
        Path(file).unlink(missing_ok=True)
        assert self.case.bodies[0].shape.volume(SPACES["3d"]) > 0  # as a plug-in might ask for
        return advance(self, *arguments)

    monkeypatch.setattr(Simulation, "advance", advanced)
    history = mpmkit.run(parse_case(scene(file)), tmp_path / "run", threads=1, checkpoint_every=1e-9)
    assert history.attrs["stopped_because"] == "finished"
    assert not Path(file).exists()


def test_a_mesh_that_changes_between_its_particles_and_its_copy_is_noticed(tmp_path, monkeypatch):
    file = ball(tmp_path / "ball.stl")
    make = Simulation.__init__

    def made(self, *arguments, **settings):
        make(self, *arguments, **settings)
        ball(tmp_path / "ball.stl", 0.09)

    monkeypatch.setattr(Simulation, "__init__", made)
    with pytest.raises(CaseError, match=r"ball\.stl, but it was changed while it was being read"):
        mpmkit.run(parse_case(scene(file)), tmp_path / "run")
    assert not (tmp_path / "run").exists()


# --- Overwriting


def test_a_run_may_replace_the_one_that_its_case_and_its_mesh_are_from(finished, tmp_path):
    shutil.copytree(finished, tmp_path / "before")
    assert status("run", finished / "case.json", "--out", finished, "--overwrite", "--quiet") == 0
    same_bits(finished, tmp_path / "before")
    assert (finished / "case.json").read_text() == (tmp_path / "before" / "case.json").read_text()
    assert files_in(finished / "meshes") == files_in(tmp_path / "before" / "meshes")


def test_a_copy_that_was_edited_may_replace_itself(finished):
    """It counts as the mesh of a new run: the name follows from its new content, and the replaced run is
    deleted."""
    (copy,) = (finished / "meshes").iterdir()
    ball(copy, 0.09)
    (finished / "meshes" / "mine.stl").write_text("the user's own")
    assert status("run", finished / "case.json", "--out", finished, "--overwrite", "--quiet") == 0
    kept = files_in(finished / "meshes")
    assert len(kept) == 2
    assert "mine.stl" in kept
    assert copy.name not in kept
    assert status("rerun", finished, "--quiet") == 0


def test_nothing_is_lost_where_the_disk_is_full(finished, tmp_path, monkeypatch, capsys):
    (copy,) = (finished / "meshes").iterdir()
    content = copy.read_bytes()

    def full(self, data):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", full)
    assert status("run", finished / "case.json", "--out", finished, "--overwrite", "--quiet") == 4
    assert copy.read_bytes() == content
    assert files_in(finished / "meshes") == [copy.name]
    said = capsys.readouterr().err
    assert f"cannot write '{copy}': No space left on device" in said
    with pytest.raises(OutputError, match="No space left"):
        mpmkit.run(load_case_beside(tmp_path, copy), tmp_path / "new")


def load_case_beside(tmp_path: Path, mesh: Path):
    (tmp_path / "scene.json").write_text(json.dumps(scene(str(mesh))))
    return load_case(tmp_path / "scene.json")


def test_a_link_in_the_place_of_the_copies_is_not_followed(finished, tmp_path):
    (finished / "meshes").rename(tmp_path / "kept")
    (finished / "meshes").symlink_to(tmp_path / "kept")
    before = files_in(tmp_path / "kept")
    sphere = {"kind": "sphere", "centre": [0.0, 0.0, 0.15], "radius": 0.1}
    case = parse_case(scene(bodies=[{"shape": sphere, "material": MATERIAL}]))
    mpmkit.run(case, finished, overwrite=True, threads=1)
    assert files_in(tmp_path / "kept") == before
    assert not (finished / "meshes").exists()


# --- Paths


def test_a_missing_mesh_is_one_sentence_that_says_where_it_was_looked_for(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cases").mkdir()
    (tmp_path / "cases" / "drop.json").write_text(json.dumps(scene("ball.stl")))
    assert status("run", "cases/drop.json") == 2
    said = capsys.readouterr().err
    assert f"the mesh's file is {tmp_path}/cases/ball.stl, but there is no such file" in said
    assert said.count("\n") == 1
    assert files_in(tmp_path) == ["cases"]


def test_paths_count_from_the_case_file_and_those_of_the_command_line_from_where_one_is(
    tmp_path, monkeypatch
):
    beside, here = ball(tmp_path / "cases" / "ball.stl", 0.09), ball(tmp_path / "cwd" / "ball.stl", 0.1)
    file = tmp_path / "cases" / "drop.json"
    file.write_text(json.dumps(scene("ball.stl")))
    monkeypatch.chdir(tmp_path / "cwd")

    def read(case):
        return str(named_files(case)[0].path)

    assert read(load_case("../cases/drop.json")) == str(tmp_path / "cwd" / ".." / "cases" / "ball.stl")
    assert read(load_case(file)) == beside
    assert read(load_case(file, ["bodies.0.shape.file=ball.stl"])) == here
    assert read(parse_case(scene("ball.stl"))) == here
    for study in ({"case": "drop.json"}, {"case": scene("ball.stl")}):
        path = tmp_path / "cases" / "study.json"
        path.write_text(json.dumps({"name": "s", **study, "vary": {"scheme.order": ["usl", "usf"]}}))
        assert [read(member.case) for member in members_of(load_study(path))] == [beside, beside]


def test_what_a_case_says_of_its_mesh_is_what_is_in_it(tmp_path):
    one, other = ball(tmp_path / "one.stl"), ball(tmp_path / "other.stl", 0.09)
    shutil.copy(one, tmp_path / "copy.stl")
    told = [portable(parse_case(scene(file))) for file in (one, str(tmp_path / "copy.stl"), other)]
    assert told[0] == told[1]
    assert told[0] != told[2]


@pytest.mark.usefixtures("undrawn")
def test_a_member_of_a_study_is_run_again_if_its_mesh_has_changed(tmp_path):
    file = ball(tmp_path / "ball.stl")
    path = tmp_path / "study.json"
    path.write_text(json.dumps({"case": scene("ball.stl"), "vary": {"scheme.order": ["usl"]}}))
    store = Store(tmp_path / "study")
    store.open(load_study(path))
    (member,) = members_of(load_study(path))
    execute([member], store, executor=Now())
    Path(file).rename(tmp_path / "moved.stl")
    shutil.copy(tmp_path / "moved.stl", file)
    (member,) = members_of(load_study(path))
    assert store.settled(member)
    ball(tmp_path / "ball.stl", 0.09)
    (member,) = members_of(load_study(path))
    assert not store.settled(member)
