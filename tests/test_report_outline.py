"""The outline of unusual scenes: off their planes of symmetry, with ejected or non-finite particles,
periodic."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from mpmkit.output import FrameWriter, History, RunDirectory, Variable, write_json
from mpmkit.report import draw_pictures
from mpmkit.report.domain import domain_of
from mpmkit.report.filling import triangles_between
from mpmkit.report.images import beyond_faces
from mpmkit.report.outline import draw
from mpmkit.report.panels import Panels
from mpmkit.report.run_results import read_results
from mpmkit.report.section import Section, lengths_of, plane_of, section_of
from mpmkit.spaces import SPACES

CELL = 0.1


def lattice(*ends):
    """Particles, two a cell and axis, that fill a box."""
    axes = [np.arange(low + CELL / 4, high, CELL / 2) for low, high in ends]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(ends))


def write_run(path, space, frames, faces=(), ended="finished", body=None, half_size=CELL / 4, **output):
    """A run directory with frames given as ``{time: positions}`` or ``{time: (positions, speeds)}``."""
    run, axes = RunDirectory(path), SPACES[space].axes
    run.claim()
    domain = {axis: [0.0 if axis in "rz" else -1.0, 1.0] for axis in axes}
    grid = {"cell_size": CELL, "domain": domain, "faces": dict(faces)}
    write_json(run.case, {"name": "scene", "space": space, "grid": grid, "output": output})
    history = History([Variable("height", "m", "largest height")], {}, axes)
    writer = FrameWriter(run.frames, SPACES[space])
    for step, (time, given) in enumerate(frames.items()):
        position, speed = given if isinstance(given, tuple) else (given, np.ones(len(given)))
        fields = {
            "speed": speed,
            "half_size": np.full((len(position), 3), half_size),
            "body": np.zeros(len(position), np.int32) if body is None else body,
        }
        writer.write(time, step, fields, position)
        history.record(time, {"height": float(position[:, -1].max())})
    history.write(run.history)
    write_json(run.summary, {"stopped_because": ended, "t500": None})
    return read_results(path)


def drawn(results, index=-1):
    return section_of(results.frames[index][1], results, plane_of(results), domain_of(results))


def panels_of(results):
    figure = draw(results)
    return [axes for axes in figure.axes if axes.get_title(loc="left")]


def test_between_two_bodies_the_section_goes_through_the_nearest_particles(tmp_path):
    boxes = [lattice((-0.3, 0.3), ends, (0, 0.4)) for ends in ((-0.8, -0.4), (0.4, 0.8))]
    results = write_run(tmp_path, "3d", {0.0: np.concatenate(boxes)})
    assert abs(plane_of(results)) == pytest.approx(0.425)
    assert len(drawn(results)) == 2 * 12 * 8  # the layers within a cell
    assert "section at y = " in draw(results).get_suptitle()


@pytest.mark.parametrize("half_size", [CELL / 4, 0.7, 5e3])
def test_no_box_is_drawn_or_measured_longer_than_a_cell_or_beyond_the_domain(tmp_path, half_size):
    """Strain can draw the box of a splash out to kilometres; that is not where material is."""
    faces = {"x_min": "slip", "x_max": "slip", "z_min": "slip"}
    points = lattice((-1.0, 0.2), (0, 0.4))
    results = write_run(tmp_path, "plane-strain", {0.0: points}, faces, half_size=half_size)
    reach = min(half_size, CELL / 2)
    assert drawn(results).half_size.max() == reach
    lengths = lengths_of(results.frames[0][1], results)
    assert lengths["spread"] == pytest.approx(1.2 - CELL / 4 + reach)  # cut off at the wall on the left
    assert lengths["height"] == pytest.approx(0.4 - CELL / 4 + reach)


def test_lengths_of_a_panel_are_no_larger_than_the_domain(tmp_path):
    faces = dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "slip")
    results = write_run(tmp_path, "plane-strain", {0.0: lattice((-1, 1), (0, 1))}, faces, half_size=9.0)
    assert lengths_of(results.frames[0][1], results) == {"spread": 2.0, "height": 1.0}


def test_a_body_off_its_plane_of_symmetry_is_cut_where_it_is(tmp_path):
    points = lattice((-0.3, 0.3), (0.3, 0.6), (0, 0.4))
    assert plane_of(write_run(tmp_path, "3d", {0.0: points}, {"y_min": "symmetry"})) == pytest.approx(0.325)


def test_a_body_that_leaves_the_section_leaves_its_panel_empty(tmp_path):
    points = lattice((-0.3, 0.3), (-0.2, 0.2), (0, 0.4))
    results = write_run(
        tmp_path, "3d", {0.0: points, 1.0: points + np.array([0, 0.7, 0])}, snapshot_times=[0.0]
    )
    assert [len(drawn(results, index)) > 0 for index in (0, 1)] == [True, False]
    first, last = panels_of(results)
    assert not first.texts
    assert last.texts[0].get_text() == "nothing in this section"
    assert draw_pictures(tmp_path)


def test_only_what_is_finite_and_in_the_domain_is_drawn(tmp_path):
    points = lattice((-0.3, 0.3), (0, 0.4))
    bad, speed = points.copy(), np.ones(len(points))
    bad[0], bad[1], bad[2], speed[3], speed[4] = np.nan, [600.0, 3.0], [0.0, -1e300], np.inf, 1e7
    frames = {0.0: points, 1.0: (bad, speed)}
    results = write_run(tmp_path, "plane-strain", frames, {"z_min": "slip"}, "particle-outside")
    assert len(drawn(results)) == len(points) - 4
    first, last = panels_of(results)
    assert np.abs(last.get_xlim()).max() < 1100  # mm, of the domain, with a margin
    assert "height 400 mm" in first.get_title(loc="left")
    assert "stopped by a guard" in last.get_title(loc="left")
    assert first.collections[0].norm.vmax == 1.0  # and not the speed of what was thrown out


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_run_without_a_finite_particle_has_no_outline(tmp_path, value):
    write_run(tmp_path, "plane-strain", {0.0: np.full((4, 2), value)}, ended="non-finite")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert draw_pictures(tmp_path) == []


def test_material_that_is_drawn_out_shows_no_stripes(tmp_path):
    points = lattice((-0.3, 0.3), (0, 0.4)) * [2, 0.5]
    section = drawn(write_run(tmp_path, "plane-strain", {0.0: points}))
    corners = section.centre[triangles_between(section, CELL)]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum() / 2
    assert area == pytest.approx(11 * CELL * 7 * CELL / 4)  # between the outermost centres, all of it


def test_separate_parts_are_drawn_separately():
    """Further than the grid reaches, or of another body."""
    points = lattice((0, 0.2), (0, 0.2))
    both = np.concatenate([points, points + np.array([0.4, 0])])
    halves, speed = np.full((len(both), 2), CELL / 4), np.ones(len(both))
    one_body, two_bodies = np.zeros(len(both)), np.repeat([0, 1], len(points))
    touching = np.concatenate([points, points + np.array([0.2, 0])])
    counts = [
        len(triangles_between(Section(centre, halves, speed, body), CELL))
        for centre, body in ((both, one_body), (touching, two_bodies), (touching, one_body))
    ]
    assert counts == [2 * 18, 2 * 18, 2 * 21]


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_particles_in_a_line_enclose_nothing(count):
    centre = np.arange(count)[:, None] * [CELL / 2, 0]
    assert len(triangles_between(Section(centre, centre, np.ones(count), np.zeros(count)), CELL)) == 0


def test_a_film_fills_its_period(tmp_path):
    """Layers that have moved on by different lengths have no ragged edge: they are of one endless film."""
    points = lattice((-1, 1), (0, 0.4))
    points[:, 0] = (points[:, 0] + 3.3 * points[:, 1] + 1) % 2 - 1
    results = write_run(
        tmp_path, "plane-strain", {0.0: points}, {"x_min": "periodic", "x_max": "periodic", "z_min": "stick"}
    )
    shown = beyond_faces(drawn(results), domain_of(results), CELL)
    for level in np.unique(points[:, 1]):
        layer = np.abs(shown.centre[:, 1] - level) < 1e-9
        assert shown.centre[layer, 0].min() - CELL / 4 < -1
        assert shown.centre[layer, 0].max() + CELL / 4 > 1
    assert shown.lower[1] == pytest.approx(-CELL)  # the image in the floor, of which nothing is seen
    (axes,) = panels_of(results)
    clip = axes.transData.inverted().transform(axes.collections[0].get_clip_box())
    assert clip.ravel() == pytest.approx([-1000, 0, 1000, 1000])


def test_different_times_have_different_titles(tmp_path):
    points = lattice((-0.3, 0.3), (0, 0.4))
    times = [0.0, 0.0501, 0.0504, 1.0]
    results = write_run(tmp_path, "plane-strain", dict.fromkeys(times, points), snapshot_times=times)
    titles = [axes.get_title(loc="left").splitlines()[0] for axes in panels_of(results)]
    assert titles == ["t = 0.0000 s", "t = 0.0501 s", "t = 0.0504 s", "t = 1.0000 s"]


def test_narrow_panels_stand_close_together():
    panels = Panels(4, np.array([0.012, 0.054]))
    width, height = panels.figure.get_size_inches()
    assert panels.figure.axes[0].get_gridspec().ncols == 4
    assert width > height
