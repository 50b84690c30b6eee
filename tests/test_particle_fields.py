"""Particle fields of frames and histories: state variables, stress, and the yielded zone."""

import copy
import json

import numpy as np
import pytest
from test_cli import one_line, status
from test_milestones import CAKE

import mpmkit
from mpmkit.contracts import ConstitutiveLaw, StateVariable
from mpmkit.output import read_frame, read_frames
from mpmkit.registry import Registered, Registry, installed
from mpmkit.report.run_results import read_results
from mpmkit.report.section import lengths_of


class Ageing(ConstitutiveLaw):
    """A law whose stress is 3 Pa of shear, and whose yield stress grows with its age."""

    name = "ageing"
    api_version = 1
    citation = "none"
    state = {
        "age": StateVariable("s", "time since the start"),
        "back_stress": StateVariable("Pa", "of nothing", (2, 2), initial=1.5),
        "pressure": StateVariable("Pa", "a name that is taken"),
    }

    def update_stress(self, motion, state, dt, stress):
        state["age"] += dt
        stress[:] = 0.0
        stress[:, 5] = 3.0

    def yield_point(self, state):
        return 1000.0 * state["age"]


@pytest.fixture(scope="module")
def registry():
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    return Registry([*found, Registered("law", Ageing, "tests", "1", "ageing")], [])


def case(registry, **output):
    data = copy.deepcopy(CAKE) | {"until": 0.01, "space": "plane-strain"}
    data["grid"]["domain"] = {"x": [-0.4, 0.4], "z": [0, 0.12]}
    material = data["bodies"][0]["material"]
    data["bodies"] = [
        {"shape": {"kind": "box", "lower": [-0.2, 0], "upper": [0, 0.1]}, "material": material},
        {
            "shape": {"kind": "box", "lower": [0, 0], "upper": [0.2, 0.1]},
            "material": {"law": "ageing", "density": 1000, "sound_speed": 10},
        },
    ]
    data["output"] = {"report": False} | output
    return mpmkit.parse_case(data, registry=registry)


def test_frames_hold_states_stress_and_the_yielded_zone(registry, tmp_path):
    mpmkit.run(case(registry), tmp_path / "run")
    time, path = read_frames(tmp_path / "run" / "frames")[-1]
    frame = read_frame(path)
    ageing = frame["body"] == 1
    assert frame["law.age"][ageing] == pytest.approx(time)
    assert np.isnan(frame["law.age"][~ageing]).all()
    assert frame["law.back_stress"].shape == (len(ageing), 4)
    assert (frame["law.back_stress"][ageing] == 1.5).all()
    assert (frame["law.pressure"][ageing] == 0).all()
    assert np.isfinite(frame["pressure"]).all()
    # VTK's order, xx, yy, zz, xy, yz, xz, in the axes of the file: its y is the vertical
    assert (frame["stress"][ageing, 3] == 3.0).all()
    assert frame["shear_stress"][ageing] == pytest.approx(3.0)
    assert not frame["yielded"][ageing].any()  # its yield stress is 10 Pa by now
    bingham = ~ageing
    assert set(np.unique(frame["yielded"][bingham])) <= {0, 1}
    flows = frame["shear_stress"][bingham] > 50 * (1 + 1e-9)
    assert (frame["yielded"][bingham] == flows).all()
    assert flows.any()


def test_frames_of_two_dimensions_lie_in_the_plane_of_a_viewer(registry, tmp_path):
    mpmkit.run(case(registry), tmp_path / "run")
    frame = read_frame(read_frames(tmp_path / "run" / "frames")[0][1])
    assert not frame["position"][:, 2].any()
    assert frame["position"][:, :2].min(axis=0) == pytest.approx([-0.195, 0.005])
    assert frame["position"][:, :2].max(axis=0) == pytest.approx([0.195, 0.095])
    assert (frame["half_size"][:, :2] > 0).all()
    assert not frame["velocity"][:, 2].any()


def test_a_history_keeps_what_it_is_asked_for(registry):
    names = ["age", "back_stress", "pressure", "pressure_of_ageing", "yielded", "shear_stress", "shear_rate"]
    names += ["law.age", "law.back_stress", "law.pressure"]  # as those without "law." were called up to 0.9
    history = mpmkit.run(case(registry, particle_history=names, history_interval=0.005))
    for name, former in (("age", "age"), ("back_stress", "back_stress"), ("pressure", "pressure_of_ageing")):
        np.testing.assert_array_equal(history[f"law.{name}"].values, history[former].values)
    assert history["law.back_stress"].dims == ("time", "particle", "law.back_stress_component")
    assert history.age.dims == ("time", "particle")
    assert history.age.attrs == {"units": "s", "long_name": "time since the start"}
    assert history.back_stress.dims == ("time", "particle", "back_stress_component")
    ageing = np.isfinite(history.age.values[-1])
    assert history.age.values[:, ageing].max(axis=1) == pytest.approx(history.time.values)
    assert history.yielded.values[-1, ~ageing].any()
    assert (history.shear_stress.values[-1, ageing] == 3.0).all()


def test_what_no_law_of_the_case_has_is_refused(tmp_path, capsys):
    (tmp_path / "cake.json").write_text(json.dumps(CAKE))
    arguments = ["--set", 'output.particle_history=["back_stress"]', "--out", tmp_path / "run"]
    assert status("run", tmp_path / "cake.json", *arguments) == 2
    sentence = one_line(capsys)
    assert 'output.particle_history.0 is "back_stress"; it must be "position", "velocity",' in sentence
    assert not (tmp_path / "run").exists()


def test_what_never_moves_has_not_yielded(registry):
    """Without gravity nothing is sheared, and no stress reaches a yield point, not even one of zero."""
    data = copy.deepcopy(CAKE) | {"until": 0.01, "gravity": [0, 0]}
    data["bodies"][0]["material"] |= {"sound_speed": 10, "yield_stress": 0}
    data["output"] = {"report": False, "particle_history": ["yielded"]}
    assert not mpmkit.run(mpmkit.parse_case(data)).yielded.values.any()


def test_lengths_in_the_report_do_not_come_from_rows(tmp_path):
    """A history with two rows; the spread of a frame is that of a row at its time."""
    data = copy.deepcopy(CAKE) | {"until": 0.1}
    rows = mpmkit.run(mpmkit.parse_case(data | {"output": {"report": False, "history_interval": 0.02}}))
    data["output"] = {"report": False, "history_interval": 0.1, "frame_interval": 0.02}
    mpmkit.run(mpmkit.parse_case(data), tmp_path / "run")
    results = read_results(tmp_path / "run")
    assert len(results.time) == 2
    for number, (time, path) in enumerate(results.frames):
        assert time == rows.time.values[number]
        found = lengths_of(path, results)
        assert found["spread"] == pytest.approx(rows.spread_diameter.values[number], rel=1e-12)
        assert found["height"] == pytest.approx(rows.height.values[number], rel=1e-12)
