"""A run opened from its directory: lazy frames, and the display of cases and runs in notebooks."""

import io
import json
import subprocess
import sys
import types
from pathlib import Path

import numpy as np
import pytest
import xarray
from test_cli import CASE

import mpmkit
from mpmkit.case import load_case, parse_case
from mpmkit.case.picture import picture
from mpmkit.errors import CaseError
from mpmkit.output import FrameWriter, read_frames
from mpmkit.results import frames as lazy
from mpmkit.results.frames import open_frames
from mpmkit.running.execution import Progress
from mpmkit.spaces import SPACES

LIFTED = Path(__file__).parents[1] / "cases" / "slump_lifted.json"
FIELDS = ["position", "velocity", "stress", "pressure", "shear_rate", "yielded", "volume_ratio"]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    case = CASE | {"output": {"report": False, "particle_history": FIELDS, "frame_interval": 0.005}}
    case["output"]["history_interval"] = 0.005
    directory = tmp_path_factory.mktemp("results") / "run"
    mpmkit.run(parse_case(case | {"name": "tiny"}), directory)
    return mpmkit.open_run(directory)


def test_frames_are_those_of_the_history(run):
    frames, history = run.frames, run.history
    same = np.intersect1d(frames.time, history.time)
    assert len(same) >= 4
    for name in FIELDS:
        xarray.testing.assert_allclose(
            frames[name].sel(time=same).drop_attrs(), history[name].sel(time=same).drop_attrs(), rtol=1e-12
        )
        assert frames[name].attrs == history[name].attrs
    assert frames.speed.attrs["units"] == "m/s"
    np.testing.assert_allclose(frames.speed, np.linalg.norm(frames.velocity, axis=2), rtol=1e-12)
    assert frames.half_size.sizes == {"time": len(frames.time), "particle": 64, "component": 2}


def test_a_file_is_read_when_its_values_are_needed(run, monkeypatch):
    read = []
    monkeypatch.setattr(lazy, "read_frame", lambda path: read.append(path) or load(path))
    load = mpmkit.output.read_frame
    lazy._loaded.cache_clear()
    files = read_frames(run.directory / "frames")
    opened = open_frames(files, SPACES["plane-strain"])
    assert set(read) <= {files[0][1], files[-1][1]}
    read.clear()
    lazy._loaded.cache_clear()
    middle = opened.isel(time=2)
    assert read == []
    assert float(middle.speed.max()) >= 0
    assert float(middle.pressure.mean()) == float(middle.pressure.mean())
    assert read == [files[2][1]]  # once for two fields


@pytest.mark.parametrize(
    "key",
    [
        {"time": 1},
        {"time": -1, "particle": 5},
        {"time": slice(0, None, 2), "particle": slice(3, 10)},
        {"time": [2, 0], "particle": [7, 1, 1]},
        {"particle": 3, "component": 1},
        {"time": [], "component": [1, 0]},
        {"time": xarray.DataArray([0, 1], dims="x"), "particle": xarray.DataArray([4, 2], dims="x")},
    ],
    ids=str,
)
def test_any_part_is_the_part_of_the_whole(run, key):
    whole = run.frames.position.load().copy()
    opened = open_frames(read_frames(run.directory / "frames"), SPACES["plane-strain"])
    xarray.testing.assert_identical(opened.position.isel(key), whole.isel(key))


def written(path, counts):
    """Frames of particles whose speed is their number, in another order in each."""
    writer = FrameWriter(path, SPACES["plane-strain"])
    rng = np.random.default_rng(0)
    for step, numbers in enumerate(counts):
        number = rng.permutation(np.array(numbers, dtype=np.int64))
        fields = {"particle": number, "speed": number.astype(float)}
        writer.write(0.1 * step, step, fields, np.column_stack([number, -number]).astype(float))
    return open_frames(read_frames(path), SPACES["plane-strain"])


def test_particles_stand_at_their_numbers_also_where_some_come_and_go(tmp_path):
    opened = written(tmp_path, [[0, 1, 2], [0, 2, 3, 5], [2, 4, 5]])
    nan = np.nan
    expected = [[0, 1, 2, nan, nan, nan], [0, nan, 2, 3, nan, 5], [nan, nan, 2, nan, 4, 5]]
    np.testing.assert_array_equal(opened.speed, expected)
    np.testing.assert_array_equal(opened.position.sel(component="z"), -np.array(expected))


def test_without_frames_there_is_a_sentence(tmp_path):
    with pytest.raises(CaseError, match=r"has no frames; see output.frame_interval"):
        open_frames([], SPACES["3d"])


def test_dask_is_not_needed(run):
    code = "import sys; sys.modules['dask'] = None; import mpmkit; "
    code += f"run = mpmkit.open_run({str(run.directory)!r}); print(float(run.frames.speed.max()) >= 0)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


def test_what_is_no_run_is_a_sentence(run, tmp_path):
    with pytest.raises(CaseError, match=r"does not hold the results of a run: it is a directory of"):
        mpmkit.open_run(tmp_path)
    assert repr(run) == f"<Run of the case 'tiny' in '{run.directory}'>"
    assert run.summary["stopped_because"] == "finished"


# --- What a notebook shows


def test_a_run_is_shown_with_its_figures_and_a_picture(run):
    shown = run._repr_html_()
    assert f"<td>{1e3 * run.summary['final_spread']:.4g} mm</td>" in shown
    assert "<td>64</td>" in shown
    assert shown.count("data:image/png;base64,") == 1  # it has no report: its shape is drawn now


def test_a_case_is_shown_as_a_table_with_units_and_a_picture():
    case = load_case(LIFTED, ['bodies.0.material.sound_speed={"factor": 10}'])
    shown = case._repr_html_()
    for part in ("axisymmetric", "72 × 61 cells of 5 mm", "yield_stress 188.91 Pa", "flow_index 1.33",
                 "frustum (height 0.3 m", "walls.mould", "z_min: slip", "10 √(2 g h)", "<svg"):  # fmt: skip
        assert part in shown


def areas(svg):
    """Pixels of each filled path."""
    paths = [part.partition('d="')[2].partition('"')[0] for part in svg.split("<path")[1:]]
    return [sum(int(run.split("v")[0]) for run in path.split("h")[1::2]) for path in paths]


@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_the_picture_has_the_areas_of_the_bodies(space):
    axes = SPACES[space].axes
    case = json.loads(json.dumps(CASE)) | {"space": space}
    case["grid"]["domain"] = {axis: [0, 1] for axis in axes}
    case["bodies"][0]["shape"] = {
        "kind": "box",
        "lower": [*[0.2, 0.3, 0][: len(axes) - 1], 0.0],
        "upper": [*[0.6, 0.5, 1][: len(axes) - 1], 0.4],
    }
    (pixels,) = areas(picture(parse_case(case)))
    assert pixels == pytest.approx(0.4 * 0.4 * 240**2, rel=0.02)


def test_the_picture_shows_walls_that_are_there_at_the_start():
    body, wall = areas(picture(load_case(LIFTED)))
    per_metre = 240 / 0.36
    assert body == pytest.approx(0.3 * 0.075 * per_metre**2, rel=0.02)
    assert wall == pytest.approx(0.3 * 0.03 * per_metre**2, rel=0.1)


def test_text_of_a_case_stays_text_and_what_cannot_be_drawn_is_left_out(monkeypatch):
    case = parse_case(CASE | {"name": "tiny", "description": "<script>alert(1)</script>"})
    assert "<script>" not in case._repr_html_()
    monkeypatch.setattr("mpmkit.case.html.picture", lambda case: 1 / 0)
    shown = case._repr_html_()
    assert "<svg" not in shown
    assert "newtonian" in shown


PROGRESS = Progress(
    time=0.5, until=2.0, ends_earlier=False, steps=10, particle_steps_per_second=1e6, seconds_left=3.0
)


def test_progress_on_a_terminal(monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    show = mpmkit.progress_bar("slump")
    show(PROGRESS)
    assert "slump" in screen.getvalue()
    assert " 25 %  t = 0.5 of 2 s, 3 s left" in screen.getvalue()
    assert not screen.getvalue().endswith("\n")
    show(Progress(2.0, 2.0, False, 40, 1e6, 0.0))
    assert screen.getvalue().endswith("\n")


def test_progress_in_a_file_says_nothing(capsys):
    mpmkit.progress_bar()(PROGRESS)
    assert capsys.readouterr() == ("", "")


def test_progress_in_a_notebook_is_one_display_that_changes(monkeypatch):
    shown = []

    class Handle:
        def update(self, html):
            shown.append(html)

    class ZMQInteractiveShell:
        pass

    display = types.ModuleType("IPython.display")
    display.HTML = str
    display.display = lambda html, display_id: shown.append(html) or Handle()
    ipython = types.ModuleType("IPython")
    ipython.get_ipython = ZMQInteractiveShell
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    show = mpmkit.progress_bar("<b>")
    show(PROGRESS)
    show(PROGRESS)
    assert len(shown) == 2
    assert '<progress max="1" value="0.2500"></progress> 25 %, t = 0.5 of 2 s, 3 s left' in shown[0]
    assert "&lt;b&gt;" in shown[0]


def test_everything_that_is_named_can_be_imported():
    for name in mpmkit.__all__:
        assert getattr(mpmkit, name) is not None
    assert hasattr(mpmkit.Run, "frames")


def test_state_variables_of_a_law_keep_their_units(tmp_path):
    from mpmkit.output.variables import ParticleVariable

    writer = FrameWriter(tmp_path, SPACES["plane-strain"])
    fields = {"age": np.ones(2), "back_stress": np.ones((2, 4)), "unknown": np.ones(2)}
    writer.write(0.0, 0, fields, np.zeros((2, 2)))
    states = {
        "age": ParticleVariable("s", "time since the start"),
        "back_stress": ParticleVariable("Pa", "of nothing", ("row", "column"), (2, 2)),
    }
    opened = open_frames(read_frames(tmp_path), SPACES["plane-strain"], states)
    assert opened.age.attrs == {"units": "s", "long_name": "time since the start"}
    assert opened.back_stress.dims == ("time", "particle", "back_stress_component")
    assert opened.back_stress.attrs["units"] == "Pa"
    assert opened.unknown.attrs["units"] == ""  # not known, and not said to be 1


def test_what_a_plug_in_adds_to_the_frames_has_its_units(tmp_path):
    case = CASE | {"name": "tiny", "until": 0.004}
    case["output"] = {"report": False, "fields": {"mu": "apparent-viscosity"}}
    mpmkit.run(parse_case(case), tmp_path / "run")
    opened = mpmkit.open_run(tmp_path / "run").frames
    assert opened.mu.attrs["units"] == "Pa s"
    np.testing.assert_allclose(opened.mu.isel(time=-1), 10.0)  # Newtonian


def test_a_case_that_may_end_earlier_says_so():
    shown = parse_case(
        CASE | {"name": "tiny", "until": {"at_most": 3.0, "max_speed": {"at_most": 1e-4}}}
    )._repr_html_()
    assert "at the latest at t = 3 s" in shown


def test_completion_in_a_notebook_knows_the_public_names():
    """They are loaded at their first use, so that Python itself would not list them."""
    assert set(mpmkit.__all__) <= set(dir(mpmkit))
