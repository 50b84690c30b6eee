"""``mpmkit movie``: pictures of fabricated runs, the shaded projection, the files, and bad input."""

import shutil

import numpy as np
import pytest
from PIL import Image
from test_report import fabricate
from test_wall_pictures import disc, write_run

from mpmkit.cli import main
from mpmkit.cli.movie import CHOICES
from mpmkit.errors import CaseError
from mpmkit.output import RunDirectory, read_frames
from mpmkit.report.movie import QUANTITIES, make_movie
from mpmkit.report.movie.moments import shown_frames
from mpmkit.report.movie.quantities import scale_of
from mpmkit.report.movie.solid import solid_pictures
from mpmkit.report.movie.splats import brightness, nearest_particles, smoothed
from mpmkit.report.movie.view import standard_view, wall_triangles, whole
from mpmkit.report.run_results import read_results


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return fabricate(tmp_path_factory.mktemp("movie") / "run", "axisymmetric", spacing=0.02)


def keep_frames(run, path, count):
    """A copy of a run with its first frames alone."""
    shutil.copytree(run, path)
    for _, file in read_frames(path / "frames")[count:]:
        file.unlink()
    return path


def pictures(path):
    image = Image.open(path)
    found = []
    for number in range(image.n_frames):
        image.seek(number)
        found.append(np.asarray(image.convert("RGB")).astype(int))
    return np.stack(found), image.info


def coloured(picture):
    """Pixels that are neither grey nor white."""
    return np.ptp(picture, axis=-1) > 30


def test_a_gif_shows_every_frame_at_its_time(run, tmp_path):
    found = keep_frames(run, tmp_path / "run", 4)
    shown, info = pictures(make_movie(found, tmp_path / "a.gif", fps=20))
    assert len(shown) == 4
    assert info["duration"] == 50
    assert info["loop"] == 0
    assert (shown[0] != shown[-1]).any()


def test_an_axisymmetric_scene_is_shown_whole(run, tmp_path):
    found = keep_frames(run, tmp_path / "run", 2)
    shown, _ = pictures(make_movie(found, tmp_path / "a.gif"))
    below_the_scale = coloured(shown[-1])[70:]
    columns = np.flatnonzero(below_the_scale.any(axis=0))
    middle = (columns[0] + columns[-1]) / 2
    left, right = below_the_scale[:, : int(middle)].sum(), below_the_scale[:, int(middle) + 1 :].sum()
    assert left == pytest.approx(right, rel=0.02)
    assert left > 1000


def test_walls_are_drawn_in_the_plane(tmp_path):
    at = {time: disc([0.5, 0.6], "plane-strain") for time in (0.0, 0.1)}
    write_run(tmp_path / "run", walls={"bar": at})
    shown, _ = pictures(make_movie(tmp_path / "run", tmp_path / "a.gif"))
    vermilion = (np.abs(shown - [213, 94, 0]).max(axis=-1) < 40).sum(axis=(1, 2))
    legend = vermilion[2]  # the wall has vanished, and its name stays
    assert vermilion[0] > legend + 100


def test_a_quarter_is_shown_whole_in_three_dimensions(tmp_path, monkeypatch):
    monkeypatch.setattr("mpmkit.report.movie.solid.RESOLUTION", 200)
    results = read_results(fabricate(tmp_path / "run", "3d", spacing=0.02))
    copies = whole(results, np.array([[0.1, 0.2, 0.3]]))
    assert {tuple(copy[0]) for copy in copies} == {(a, b, 0.3) for a in (0.1, -0.1) for b in (0.2, -0.2)}
    frames = results.frames[:2]
    first, last = solid_pictures(results, frames, QUANTITIES["speed"])
    assert first.shape == last.shape
    assert coloured(first)[70:].sum() > 5000


def test_walls_in_three_dimensions_have_their_images(tmp_path):
    ball = disc([0.5, -1.0, 0.5], "3d", half=True)
    results = write_run(tmp_path, "3d", faces={"y_min": "symmetry"}, walls={"ball": {0.0: ball}})
    triangles = wall_triangles(results, 0.0)["ball"]
    assert triangles.shape == (2 * len(ball.parts), 3, 3)
    assert triangles[..., 1].mean() == pytest.approx(-1.0)


def test_the_view_is_a_rotation():
    view = standard_view()
    turned = np.array([view.right, view.up, view.towards])
    np.testing.assert_allclose(turned @ turned.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(turned) == pytest.approx(1)
    assert view.seen(np.array([0.0, 0.0, 1.0]))[1] > 0.9  # up is up


def test_the_nearest_ball_is_seen_and_its_depth_is_that_of_a_sphere():
    places = np.array([[20.0, 20.0, 0.0], [20.0, 20.0, 30.0], [50.0, 20.0, 5.0]])
    depth, number = nearest_particles(places, np.array([15.0, 5.0, 8.0]), (40, 70))
    assert number[20, 20] == 1
    assert number[20, 30] == 0
    assert number[20, 50] == 2
    assert number[0, 0] == -1
    assert depth[0, 0] == -np.inf
    assert depth[20, 30] == pytest.approx(np.sqrt(15**2 - 10**2))
    assert (number == 2).sum() == pytest.approx(np.pi * 8**2, rel=0.05)


def test_the_side_that_faces_the_light_is_brighter():
    depth, _ = nearest_particles(np.array([[30.0, 30.0, 0.0]]), np.array([25.0]), (60, 60))
    lit = brightness(depth)
    assert lit[15, 15] > lit[45, 45]  # the light comes from the upper left
    assert lit[0, 0] == 0
    assert lit.max() == pytest.approx(1, abs=0.02)


def test_smoothing_closes_the_furrows_between_balls_and_keeps_a_step():
    centres = np.stack(np.meshgrid(np.arange(0, 60, 6.0), np.arange(0, 60, 6.0)), axis=-1).reshape(-1, 2)
    height = np.where(centres[:, 0] < 30, 0.0, 100.0)
    depth, _ = nearest_particles(np.column_stack([centres, height]), np.full(100, 6.0), (54, 54))
    plain = smoothed(depth, 6.0, 12.0)
    assert np.ptp(plain[10:40, 5:20]) < 0.4 * np.ptp(depth[10:40, 5:20])
    assert plain[20, 40] - plain[20, 10] == pytest.approx(100, abs=1)


def test_the_pictures_are_even_in_time(run):
    times = [0.0, 0.04, 0.08, 0.1, 0.12, 0.16, 0.2]  # with one snapshot in between
    results = read_results(run)
    results = type(results)(results.case, {}, results.history, [(t, run / str(t)) for t in times], {})
    assert [time for time, _ in shown_frames(results, run)] == [0.0, 0.04, 0.08, 0.12, 0.16, 0.2]


@pytest.mark.parametrize(("count", "there"), [(0, "no frames"), (1, "only one frame")])
def test_too_few_frames_are_a_sentence_that_names_the_key(run, tmp_path, count, there):
    found = keep_frames(run, tmp_path / "run", count)
    with pytest.raises(CaseError, match=f"has {there}, and a movie needs at least 2: .*--set output.frame_"):
        make_movie(found, tmp_path / "a.gif")


def test_the_scale_holds_for_all_pictures():
    speeds = [np.array([0.0, 1.0]), np.array([0.2, 3.0])]
    scale = scale_of(QUANTITIES["speed"], speeds)
    assert (scale.norm.vmin, scale.norm.vmax, scale.extend) == (0, 3, "neither")
    rates = np.append(np.linspace(0, 10, 1000), 1e6)
    scale = scale_of(QUANTITIES["shear-rate"], [rates])
    assert scale.norm.vmax == pytest.approx(9.8, rel=0.01)
    assert scale.extend == "max"
    still = scale_of(QUANTITIES["speed"], [np.zeros(3)])
    assert still.norm.vmax > still.norm.vmin
    assert [scale_of(QUANTITIES["yielded"], []).norm(value) for value in (0, 1)] == [0, 1]


def test_the_choices_of_the_option_are_those_of_the_movie():
    assert set(CHOICES) == set(QUANTITIES)


def movie(*arguments):
    with pytest.raises(SystemExit) as ended:
        main(["movie", *map(str, arguments)])
    return ended.value.code


def test_the_command_writes_beside_the_report_and_a_new_run_clears_it(run, tmp_path, capsys):
    found = keep_frames(run, tmp_path / "run", 2)
    assert movie(found) == 0
    path = found / "report" / "movie.gif"
    assert capsys.readouterr().out == f"{path}\n"
    assert movie(found) == 0  # like the pictures of the report, it is replaced
    RunDirectory(found, overwrite=True).claim()
    assert not path.exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nowhere"], "does not hold the results of a run"),
        (["run", "--out", "a.avi"], "its name must end in .gif or .mp4"),
        (["run", "--out", "there.gif"], "'there.gif' exists: give --overwrite"),
        (["run", "--fps", "0"], "0.0 is not in the range"),
        (["run", "--colour-by", "heat"], "'heat' is not one of 'speed', 'shear-rate', 'yielded', 'pressure'"),
        (
            ["run", "--colour-by", "pressure"],
            "have no 'pressure' to colour by; they can be coloured by speed",
        ),
        (["run", "--out", "no/folder.gif"], "cannot write 'no/folder.gif': No such file or directory"),
    ],
)
def test_bad_input_is_one_sentence(run, tmp_path, monkeypatch, capsys, arguments, said):
    monkeypatch.chdir(tmp_path)
    keep_frames(run, tmp_path / "run", 2)
    (tmp_path / "there.gif").touch()
    assert movie(*arguments) in (2, 4)
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert (tmp_path / "there.gif").read_bytes() == b""
    assert not list(tmp_path.glob(".*.partial"))


def test_mp4_without_its_package_says_what_to_install(run, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    with pytest.raises(CaseError, match=r"pip install imageio-ffmpeg, or write a .gif"):
        make_movie(run, tmp_path / "a.mp4")


def test_mp4(run, tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="MP4 needs the extra 'movie'")
    found = keep_frames(run, tmp_path / "run", 3)
    path = make_movie(found, tmp_path / "a.mp4", fps=5)
    reader = ffmpeg.read_frames(str(path))
    about = next(reader)
    assert about["fps"] == 5
    assert about["codec"] == "h264"
    assert about["pix_fmt"].startswith("yuv420p")
    assert len(list(reader)) == 3 + 5  # the last picture is held for a second


def test_a_frame_that_is_cut_off_is_a_sentence(run, tmp_path, capsys):
    found = keep_frames(run, tmp_path / "run", 2)
    last = read_frames(found / "frames")[-1][1]
    last.write_bytes(last.read_bytes()[:200])
    assert movie(found) == 2
    assert capsys.readouterr().err.startswith(f"mpmkit: the frame '{last}' cannot be read: ")
    with pytest.raises(SystemExit) as ended:
        main(["report", str(found)])
    assert ended.value.code == 2
