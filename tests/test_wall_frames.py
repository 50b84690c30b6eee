"""Frames of walls: what a viewer shows of each wall at each time, and what a resumed run adds to them."""

from typing import ClassVar

import meshio
import numpy as np
import pytest

import mpmkit
from mpmkit.contracts import Surface
from mpmkit.output import Drawn, RunDirectory, WallFrameWriter, read_wall_frame, read_wall_frames
from mpmkit.output.pvd import read_pvd
from mpmkit.running.runner import resume
from mpmkit.running.wall_frames import WallFrames
from mpmkit.spaces import SPACES

CELL = 0.05
SEGMENT = Drawn(np.array([[0.0, 1.0], [2.0, 3.0]]), np.array([[0, 1]]), np.array([[0.5, 0.0], [0.0, 0.5]]))
GONE = Drawn(np.zeros((0, 2)), np.zeros((0, 2), dtype=int), np.zeros((0, 2)))


def case_of(walls, space="plane-strain", faces=None, until=0.5):
    """A block in a box, and walls with it."""
    axes = SPACES[space].axes
    low = 0.0 if space == "axisymmetric" else -0.5
    domain = {axes[0]: [low, 0.5], axes[-1]: [0.0, 0.5]} | ({"y": [-0.5, 0.5]} if len(axes) == 3 else {})
    return mpmkit.parse_case(
        {
            "space": space,
            "until": until,
            "output": {"report": False},
            "grid": {"cell_size": CELL, "domain": domain, "faces": faces or {"z_min": "stick"}},
            "walls": walls,
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [-0.1, 0.0], "upper": [0.1, 0.1]}
                    if space == "plane-strain"
                    else {"kind": "cylinder", "radius": 0.1, "height": 0.1},
                    "material": {
                        "law": "newtonian",
                        "density": 1000.0,
                        "viscosity": 5.0,
                        "sound_speed": 15.0,
                    },
                }
            ],
        }
    )


def body(kind, side="inside", **more):
    shapes = {
        "frustum": {"kind": "frustum", "bottom_radius": 0.2, "top_radius": 0.15, "height": 0.3},
        "box": {"kind": "box", "lower": [0.2, 0.1], "upper": [0.4, 0.3]},
        "rod": {"kind": "cylinder", "radius": 0.1, "height": 0.2, "base": [0.0, 0.3]},
    }
    return {"surface": {"kind": "body", "shape": shapes[kind], "side": side} | more, "contact": "slip"}


@pytest.fixture
def drawn(tmp_path):
    """Draws the walls of a case at times; gives back what is there at each."""

    def draw(case, *times):
        frames = WallFrames(case, tmp_path, goes_on=False)
        for step, time in enumerate(times):
            frames.add(time, step)
        listed = read_wall_frames(tmp_path)
        assert list(listed) == list(times)
        return [{name: read_wall_frame(path) for name, path in listed[time].items()} for time in times]

    return draw


def test_a_moving_shell_is_where_it_is_at_each_time_with_its_velocity(drawn):
    lift = {"kind": "velocity", "velocity": [0, 0.3], "start": 0.1}
    case = case_of({"mould": body("frustum", thickness=0.05, motion=lift)}, "axisymmetric")
    first, second = drawn(case, 0.0, 0.3)
    for frame, up, speed in ((first, 0.0, 0.0), (second, 0.06, 0.3)):
        points, _, velocity = frame["mould"]
        assert points[:, 1].min() == pytest.approx(up, abs=1e-9)
        inner = np.abs(points[:, 0] - 0.2 + (points[:, 1] - up) / 6) < 1e-6
        assert inner.sum() > 30  # both of its sides
        assert (~inner).sum() > 30
        np.testing.assert_allclose(velocity, np.tile([0, speed, 0], (len(points), 1)))


def test_a_wall_at_rest_is_drawn_once_and_listed_at_every_time(drawn, tmp_path):
    turn = {"kind": "rotation", "point": [0.0, 0.0], "rate": 1.0}
    case = case_of({"bar": body("box", "outside"), "mill": body("box", "outside", motion=turn)})
    frames = drawn(case, 0.0, 0.1, 0.2)
    assert [sorted(frame) for frame in frames] == [["bar", "mill"]] * 3
    files = sorted(path.name for path in (tmp_path / "walls").iterdir())
    assert files == ["bar_000000.vtu", "mill_000000.vtu", "mill_000001.vtu", "mill_000002.vtu"]
    middle = [frame["mill"].points[:, :2] for frame in frames]
    for time, place in zip((0.0, 0.1, 0.2), middle, strict=True):
        turned = [np.hypot(0.3, 0.2) * f(np.arctan2(0.2, 0.3) + time) for f in (np.cos, np.sin)]
        np.testing.assert_allclose((place.min(axis=0) + place.max(axis=0)) / 2, turned, atol=1e-3)


def test_a_wall_is_drawn_only_while_it_is_there(drawn, tmp_path):
    gate = body("box", "outside", appears=0.1, vanishes=0.3)
    frames = drawn(case_of({"gate": gate, "bar": body("box", "outside")}), 0.0, 0.2, 0.3)
    assert [sorted(frame) for frame in frames] == [["bar"], ["bar", "gate"], ["bar"]]
    # A viewer finds an empty part, and does not go on showing the last one.
    entries = [entry for entry in read_pvd(tmp_path / "walls.pvd") if entry.name == "gate"]
    assert [entry.file for entry in entries] == [
        "walls/nothing.vtu",
        "walls/gate_000001.vtu",
        "walls/nothing.vtu",
    ]
    assert 'NumberOfPoints="0"' in (tmp_path / "walls/nothing.vtu").read_text()


class Waved(Surface):
    """A third party's surface, with nothing but a distance."""

    name = "waved"
    api_version = 2
    citation = "none"
    height: ClassVar[float] = 0.2

    def distance(self, x, t):
        slope = 0.1 * np.cos(10 * x[:, 0])
        length = np.hypot(1, slope)
        d = (x[:, -1] - self.height - 0.01 * np.sin(10 * x[:, 0])) / length
        normal = np.zeros_like(x)
        normal[:, 0], normal[:, -1] = -slope / length, 1 / length
        return d, normal


def test_a_wall_that_has_left_the_domain_is_not_asked_for_its_velocity(drawn):
    away = {"kind": "velocity", "velocity": [0, 100.0]}
    frames = drawn(case_of({"bar": body("box", "outside", motion=away)}), 0.0, 0.1)
    assert [sorted(frame) for frame in frames] == [["bar"], []]


@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_a_surface_that_has_only_a_distance_is_drawn(drawn, space):
    case = case_of(
        {
            "floor": body("rod", "outside")
            if space == "plane-strain"
            else {"surface": {"kind": "plane", "point": [0, 0, 0.1], "normal": [0, 0, 1]}, "contact": "slip"}
        },
        space,
    )
    wall = case.walls["floor"].model_copy(update={"surface": Waved()})
    [frame] = drawn(case.model_copy(update={"walls": {"floor": wall}}), 0.0)
    points, parts, velocity = frame["floor"]
    up = 1 if space == "plane-strain" else 2
    np.testing.assert_allclose(points[:, up], 0.2 + 0.01 * np.sin(10 * points[:, 0]), atol=2e-5)
    assert parts.shape[1] == SPACES[space].dim
    assert not velocity.any()
    assert points[:, 0].min() == pytest.approx(-0.5 - CELL)
    assert points[:, 0].max() == pytest.approx(0.5 + CELL)


def test_nothing_is_drawn_behind_a_symmetry_or_the_axis(drawn):
    floor = {"surface": {"kind": "plane", "point": [0, 0, 0.2], "normal": [0, 0, 1]}, "contact": "stick"}
    [frame] = drawn(case_of({"floor": floor}, "3d", {"x_min": "symmetry"}), 0.0)
    points = frame["floor"].points
    np.testing.assert_allclose(points.min(axis=0), [-0.5, -0.5 - CELL, 0.2])
    np.testing.assert_allclose(points.max(axis=0), [0.5 + CELL, 0.5 + CELL, 0.2])


class TestWriter:
    def test_files_are_read_back_and_are_what_meshio_reads(self, tmp_path):
        writer = WallFrameWriter(tmp_path, SPACES["plane-strain"], ("a", "b"))
        writer.write(0.0, 0, {"a": SEGMENT, "b": GONE})
        writer.write(0.5, 7, {"a": None, "b": SEGMENT})
        assert read_wall_frames(tmp_path) == {
            0.0: {"a": tmp_path / "walls/a_000000.vtu"},
            0.5: {"a": tmp_path / "walls/a_000000.vtu", "b": tmp_path / "walls/b_000007.vtu"},
        }
        mesh = meshio.read(tmp_path / "walls/b_000007.vtu")
        np.testing.assert_array_equal(mesh.points, [[0, 1, 0], [2, 3, 0]])
        np.testing.assert_array_equal(mesh.get_cells_type("line"), [[0, 1]])
        np.testing.assert_array_equal(mesh.point_data["velocity"], [[0.5, 0, 0], [0, 0.5, 0]])
        entries = read_pvd(tmp_path / "walls.pvd")
        assert [(entry.part, entry.name) for entry in entries] == [(0, "a"), (1, "b")] * 2

    def test_goes_on_after_those_of_a_checkpoint(self, tmp_path):
        writer = WallFrameWriter(tmp_path, SPACES["plane-strain"], ("a",))
        writer.write(0.0, 0, {"a": SEGMENT})
        state = writer.state()
        writer.write(0.5, 5, {"a": SEGMENT})  # after the checkpoint, and before the run was killed
        again = WallFrameWriter(tmp_path, SPACES["plane-strain"], ("a",), goes_on=True)
        again.restore(state)
        assert read_wall_frames(tmp_path) == {0.0: {"a": tmp_path / "walls/a_000000.vtu"}}
        assert not (tmp_path / "walls/a_000005.vtu").exists()
        again.write(0.25, 3, {"a": None})
        assert list(read_wall_frames(tmp_path)) == [0.0, 0.25]

    def test_overwriting_leaves_what_is_the_users(self, tmp_path):
        run = RunDirectory(tmp_path / "run", overwrite=True)
        run.claim()
        run.case.write_text("{}")
        run.frames.mkdir()
        WallFrameWriter(run.frames, SPACES["plane-strain"], ("a",)).write(0.0, 0, {"a": GONE})
        run.claim()
        assert not list(run.path.iterdir())
        run.case.write_text("{}")
        run.frames.mkdir()
        WallFrameWriter(run.frames, SPACES["plane-strain"], ("a",)).write(0.0, 0, {"a": SEGMENT})
        (run.frames / "walls/mine.vtu").write_text("the user's own")
        run.claim()
        assert [path.name for path in run.path.rglob("*") if path.is_file()] == ["mine.vtu"]

    def test_a_run_without_walls_has_none(self, tmp_path):
        WallFrameWriter(tmp_path, SPACES["3d"], ())
        assert not list(tmp_path.iterdir())
        assert read_wall_frames(tmp_path) == {}


def test_walls_and_particles_of_a_run_have_the_same_times(tmp_path):
    case = case_of({"bar": body("box", "outside")}, until=0.01)
    mpmkit.run(case, out=tmp_path / "run")
    frames = tmp_path / "run" / "frames"
    assert [e.time for e in read_pvd(frames / "walls.pvd")] == [
        e.time for e in read_pvd(frames / "frames.pvd")
    ]
    assert len(list((frames / "walls").iterdir())) == 1


def test_a_run_that_goes_on_has_the_walls_of_one_that_was_not_stopped(tmp_path):
    turn = {"kind": "rotation", "point": [0.3, 0.2], "rate": 20.0}
    walls = {"mill": body("box", "outside", motion=turn), "gate": body("box", "outside", vanishes=0.012)}
    data = case_of(walls, until=0.02).model_dump(mode="json", exclude_unset=True)
    data["output"] = {"report": False, "frame_interval": 0.004}
    mpmkit.run(mpmkit.parse_case(data), out=tmp_path / "whole")
    mpmkit.run(mpmkit.parse_case(data | {"until": 0.01}), out=tmp_path / "stopped")
    resume(tmp_path / "stopped", until=0.02)
    whole, stopped = (tmp_path / name / "frames" for name in ("whole", "stopped"))
    files = sorted(path.relative_to(whole) for path in whole.glob("walls/*"))
    assert files == sorted(path.relative_to(stopped) for path in stopped.glob("walls/*"))
    assert len(files) == 6 + 2  # the mill at six times; the gate, and that it is gone
    for name in [*files, "walls.pvd"]:
        assert (whole / name).read_bytes() == (stopped / name).read_bytes()
