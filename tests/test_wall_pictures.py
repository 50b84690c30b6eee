"""Walls in the pictures of a report: their positions at each time, their names, and their forces."""

import numpy as np
import pytest
from mpmkit_plugins.body_shapes.sphere import Sphere

from mpmkit.geometry import contour
from mpmkit.output import (
    Drawn,
    FrameWriter,
    History,
    RunDirectory,
    Variable,
    WallFrameWriter,
    write_json,
)
from mpmkit.output.columns import wall_columns
from mpmkit.report import draw_pictures, outline, wall_forces
from mpmkit.report.domain import domain_of
from mpmkit.report.run_results import read_results
from mpmkit.report.section import plane_of
from mpmkit.report.style import FACE_COLOURS, WALL_COLOURS
from mpmkit.report.wall_lines import wall_lines
from mpmkit.spaces import SPACES

CELL = 0.1
TIMES = (0.0, 0.1, 0.5)


def disc(centre, space, rate=0.0, speed=0.0, half=False):
    """A disc or a ball as it is drawn, whole or half; it moves along the last axis, or turns about y."""
    solid = Sphere(centre=list(centre), radius=0.2).solid(SPACES[space])
    lower = np.array(centre) - [0.3, 0.0 if half else 0.3, 0.3][: len(centre)]
    points, parts = contour(solid.distance, lower, np.array(centre) + 0.31, 0.02)
    arm = points - centre
    velocity = np.zeros_like(points)
    velocity[:, 0], velocity[:, -1] = -rate * arm[:, -1], rate * arm[:, 0] + speed
    return Drawn(points, parts, velocity)


def write_run(
    path, space="plane-strain", faces=(), walls=None, names=None, force=None, torque=None, power=None
):
    """A run directory of a block, with walls given as ``{name: {time: Drawn}}``, and what they give."""
    run, axes = RunDirectory(path), SPACES[space].axes
    run.claim()
    domain = {axis: [0.0 if axis in "rz" else -1.0, 1.0] for axis in axes}
    grid = {"cell_size": CELL, "domain": domain, "faces": dict(faces)}
    walls = walls or {}
    case = {
        "name": "scene",
        "space": space,
        "grid": grid,
        "output": {},
        "walls": {name: {} for name in walls},
    }
    write_json(run.case, case)
    names = list(walls) if names is None else names
    columns = [Variable("height", "m", "largest height"), *(wall_columns(axes) if names else ())]
    history = History(columns, {}, axes, walls=names)
    sides = [np.arange(0.025, 0.4, 0.05)] * len(axes)
    position = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, len(axes))
    writer, drawn = (
        FrameWriter(run.frames, SPACES[space]),
        WallFrameWriter(run.frames, SPACES[space], list(walls)),
    )
    nothing = Drawn(*(np.zeros((0, len(axes)), dtype=t) for t in (float, int, float)))
    about = 3 if len(axes) == 3 else 1
    given = {"wall_force": force, "wall_torque": torque, "wall_power": power}
    shapes = {"wall_force": (len(axes),), "wall_torque": (about,), "wall_power": ()}
    for step, time in enumerate(TIMES):
        n = len(position)
        fields = {"speed": np.ones(n), "half_size": np.full((n, 3), 0.025), "body": np.zeros(n, np.int32)}
        writer.write(time, step, fields, position)
        drawn.write(time, step, {name: at.get(time, nothing) for name, at in walls.items()})
        row = {"height": 0.4}
        if names:
            for key, shape in shapes.items():
                value = np.zeros((len(names), *shape)) if given[key] is None else np.array(given[key], float)
                row[key] = value * (time > 0)
        history.record(time, row)
    history.write(run.history)
    write_json(run.summary, {"stopped_because": "finished", "t500": None})
    return read_results(path)


def lines_at(results, time):
    return wall_lines(results, time, plane_of(results), domain_of(results))


def test_a_wall_is_drawn_where_it_is_at_the_time_of_the_picture(tmp_path):
    at = {0.0: disc([0.5, 0.3], "plane-strain"), 0.1: disc([0.5, 0.6], "plane-strain")}
    results = write_run(tmp_path, walls={"bar": at})
    for time, height in ((0.0, 0.3), (0.1, 0.6)):
        ends = lines_at(results, time)["bar"].reshape(-1, 2)
        np.testing.assert_allclose(np.linalg.norm(ends - [0.5, height], axis=1), 0.2)
    assert lines_at(results, 0.5) == {}  # it has vanished


def test_half_a_wall_is_drawn_whole_about_the_axis(tmp_path):
    results = write_run(tmp_path, "axisymmetric", walls={"bar": {0.0: disc([0.5, 0.3], "plane-strain")}})
    ends = lines_at(results, 0.0)["bar"].reshape(-1, 2)
    for sign in (1, -1):
        half = ends[sign * ends[:, 0] > 0]
        np.testing.assert_allclose(np.linalg.norm(half - [sign * 0.5, 0.3], axis=1), 0.2)


@pytest.mark.parametrize("faces", [{}, {"y_min": "symmetry"}], ids=["middle", "symmetry"])
def test_a_wall_in_three_dimensions_is_cut_by_the_plane_of_the_picture(tmp_path, faces):
    middle = -1.0 if faces else 0.2
    ball = disc([0.5, middle, 0.5], "3d", half=bool(faces))  # what is drawn ends at a symmetry
    results = write_run(tmp_path, "3d", faces, walls={"ball": {0.0: ball}})
    plane = middle if faces else plane_of(results)
    segments = wall_lines(results, 0.0, plane, domain_of(results))["ball"]
    across = np.sqrt(0.04 - (plane - middle) ** 2)
    ends = np.linalg.norm(segments.reshape(-1, 2) - [0.5, 0.5], axis=1)
    np.testing.assert_allclose(ends, across, atol=0.01)
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum()
    assert length == pytest.approx(2 * np.pi * across, rel=0.03)


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()] if figure.legends else []


def test_the_legend_names_the_walls_that_a_panel_shows(tmp_path):
    near, far = disc([0.4, 0.3], "plane-strain"), disc([-0.7, 0.8], "plane-strain")
    walls = {"far": {0.0: far}, "bar": {0.1: near}, "gone": {}}
    results = write_run(tmp_path, walls=walls)
    assert legend(outline.draw(results)) == ["bar"]


def test_without_walls_there_is_no_legend_and_no_picture_of_forces(tmp_path):
    results = write_run(tmp_path)
    assert legend(outline.draw(results)) == []
    assert wall_forces.draw(results) is None
    assert [path.name for path in draw_pictures(tmp_path)] == ["outline.png", "spread_and_height.png"]


def charts(figure):
    return {axes.get_ylabel(): {line.get_color() for line in axes.lines} for axes in figure.axes}


STILL = {"bar": {0.0: disc([0.5, 0.3], "plane-strain")}}
TURNS = {"bar": {0.0: disc([0.5, 0.3], "plane-strain", rate=2.0)}}
LIFTS = {"bar": {0.0: disc([0.5, 0.3], "plane-strain", speed=0.3)}}


@pytest.mark.parametrize(
    ("walls", "power", "expected"),
    [
        (STILL, [0.0], ["force along x (N)", "force along z (N)"]),
        (LIFTS, [7.0], ["force along x (N)", "force along z (N)", "power (W)"]),
        (TURNS, [7.0], ["force along x (N)", "force along z (N)", "torque about y (N m)", "power (W)"]),
    ],
    ids=["at rest", "lifted", "turning"],
)
def test_torque_where_a_wall_turns_and_power_where_one_moves(tmp_path, walls, power, expected):
    results = write_run(tmp_path, walls=walls, force=[[3.0, -2.0]], torque=[[5.0]], power=power)
    assert list(charts(wall_forces.draw(results))) == expected


def test_in_three_dimensions_the_torque_is_about_the_axis_of_the_turn(tmp_path):
    walls = {"ball": {0.0: disc([0.5, 0.2, 0.5], "3d", rate=2.0)}}
    results = write_run(tmp_path, "3d", walls=walls, force=[[0.0, 0.0, 1.0]], torque=[[4.0, 5.0, 6.0]])
    assert list(charts(wall_forces.draw(results))) == ["force along z (N)", "torque about y (N m)"]


def test_faces_of_the_grid_are_drawn_beside_walls_in_colours_of_their_own(tmp_path):
    names = ["x_min", "z_min", "bar"]
    force = [[0.0, 0.0], [0.0, 9.0], [3.0, 2.0]]
    figure = wall_forces.draw(write_run(tmp_path, walls=STILL, names=names, force=force))
    assert legend(figure) == ["bar", "z_min"]  # nothing touches x_min
    found = charts(figure)
    assert found["force along x (N)"] == {WALL_COLOURS[0]}
    assert found["force along z (N)"] == {WALL_COLOURS[0], FACE_COLOURS[1]}


def test_of_many_walls_the_strongest_are_drawn_and_the_others_counted(tmp_path):
    names = [f"wall{number}" for number in range(20)]
    force = [[float(number), 0.0] for number in range(20)]
    shape = disc([0.5, 0.3], "plane-strain")
    results = write_run(tmp_path, walls={name: {0.0: shape} for name in names}, force=force)
    figure = wall_forces.draw(results)
    assert legend(figure) == names[-wall_forces.MOST :]
    assert figure.legends[0].get_title().get_text() == "and 11 more, with smaller forces"
    assert len(outline.draw(results).legends[0].get_texts()) == 20


def test_walls_that_nothing_touches(tmp_path):
    figure = wall_forces.draw(write_run(tmp_path, walls=STILL))
    assert [text.get_text() for text in figure.axes[0].texts] == ["no wall was touched"]


def test_the_pictures_are_written(tmp_path):
    write_run(tmp_path, walls=TURNS, force=[[3.0, -2.0]], torque=[[5.0]], power=[7.0])
    names = [path.name for path in draw_pictures(tmp_path)]
    assert names == ["outline.png", "spread_and_height.png", "wall_forces.png"]
