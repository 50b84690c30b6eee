"""Runs that end at rest, or when a variable of the history reaches a value."""

from __future__ import annotations

import json
import logging
import signal
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray
from studies import CASE, study
from test_cli import status
from test_milestones import CAKE
from test_study import run

import mpmkit
from mpmkit.case import load_case, parse_case
from mpmkit.errors import CaseError, Interrupted
from mpmkit.plan import plan
from mpmkit.running.ending import KEPT, Ending
from mpmkit.running.milestones import LOOKS, Milestones
from mpmkit.running.runner import resume

SLUMP = Path(__file__).parents[1] / "cases/slump_fast.json"
COARSE = [
    "grid.cell_size=0.04",
    'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}',
    "output.report=false",
    "output.history_interval=0.01",
    "output.frame_interval=1",
]


def slump(until):
    return load_case(SLUMP, [*COARSE, f"until={json.dumps(until)}"])


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """The same slump until it rests, and to 4 s."""
    place = tmp_path_factory.mktemp("until")
    mpmkit.run(slump({"rest": True, "at_most": 10}), place / "rest")
    mpmkit.run(slump(4.0), place / "long")
    return place


def summary(run):
    return json.loads((run / "summary.json").read_text())


def test_a_slump_until_it_rests_has_the_lengths_of_one_to_4_s(runs):
    rest, long = summary(runs / "rest"), summary(runs / "long")
    assert rest["stopped_because"] == "at-rest"
    assert long["stopped_because"] == "finished"
    for name in ("final_spread", "final_slump", "final_height"):
        assert rest[name] == pytest.approx(long[name], abs=1e-4), name
    assert rest["at_rest_since"] == long["at_rest_since"]
    assert rest["at_rest_since"] < rest["simulated_time"] < 0.75 * 4
    assert rest["t500"] == long["t500"]
    log = (runs / "rest/run.log").read_text()
    assert "the run ends when the material is at rest, at the latest at t = 10 s" in log
    assert f"at-rest after {rest['steps']} steps" in log
    assert f"at rest since t = {rest['at_rest_since']:.3g} s" in log


def test_it_goes_on_to_a_later_time_as_one_that_was_as_long_from_the_start(runs, tmp_path, caplog):
    case = slump({"rest": True, "at_most": 10})
    mpmkit.run(case, tmp_path / "run")
    with pytest.raises(
        CaseError, match=r"has finished: .*; --until T with a T above \d\.\d+ s makes it longer"
    ):
        resume(tmp_path / "run")
    with pytest.raises(CaseError, match=r"until is 0\.5 s; .* can only go on to a later time"):
        resume(tmp_path / "run", until=0.5)
    assert status("run", "--resume", str(tmp_path / "run"), "--until", "4", "--quiet") == 0
    same(tmp_path / "run", runs / "long")
    assert json.loads((tmp_path / "run/case.json").read_text())["until"] == 4.0


def same(a: Path, b: Path):
    with xarray.open_dataset(a / "history.nc") as one, xarray.open_dataset(b / "history.nc") as other:
        xarray.testing.assert_identical(one.drop_attrs(), other.drop_attrs())


def test_an_interrupted_run_ends_where_it_would_have(runs, tmp_path, monkeypatch):
    """The band in which lengths have stayed, and since when, is in the checkpoint."""

    def listen(progress):
        assert progress.ends_earlier
        if progress.time > 1.6:
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("mpmkit.running.execution.TOLD_EVERY", 0.0)
    before = signal.signal(
        signal.SIGINT, signal.default_int_handler
    )  # ignored where tests run in the background
    with pytest.raises(Interrupted):
        mpmkit.run(slump({"rest": True, "at_most": 10}), tmp_path / "run", listen=listen)
    signal.signal(signal.SIGINT, before)
    assert summary(tmp_path / "run")["simulated_time"] < 1.7
    resume(tmp_path / "run")
    same(tmp_path / "run", runs / "rest")
    assert summary(tmp_path / "run")["steps"] == summary(runs / "rest")["steps"]


class Three:
    """Three particles at one place."""

    def __init__(self):
        self.mass, self.velocity, self.position = np.ones(3), np.zeros((3, 2)), np.zeros((3, 2))

    def __len__(self):
        return 3


def scripted(spread, speed, height=0.3, walls=()):
    """A stand-in for a simulation, whose spread and RMS speed follow functions of time; 1 m/s at first."""
    case = parse_case(CAKE | {"until": {"rest": True, "at_most": 100}})
    scene = SimpleNamespace(time=0.0, steps=0, case=case.model_copy(), settled=True)
    scene.case.__dict__["height"] = height
    scene.particles = Three()
    scene.measures = SimpleNamespace(spread=lambda p: spread(scene.time), height=lambda p: 0.02)
    scene.grid = SimpleNamespace(periodic=np.zeros(2, dtype=bool))
    sources = SimpleNamespace(goes_on=lambda time: False)
    scene.operations = SimpleNamespace(walls=SimpleNamespace(walls=list(walls)), sources=sources)
    scene.drains = SimpleNamespace(emptied="")
    milestones = Milestones(scene)
    ending = Ending(scene, milestones)
    while scene.time < 20 and not ending.ended:
        scene.particles.velocity[:, 0] = speed(scene.time)
        milestones.watch()
        ending.watch()
        scene.steps += 1
        scene.time += 1e-3
    return scene, ending, milestones


def stops(t):
    return 1.0 if t < 1 else 0.0


def test_creep_is_not_rest():
    """At 0.5 mm/s the material is at rest for the milestones, which look at h/U = 0.3 s alone."""
    scene, ending, milestones = scripted(lambda t: 0.5 + 5e-4 * t, lambda t: stops(t) or 5e-4)
    assert milestones.at_rest_since is not None
    assert not ending.ended
    scene, ending, _ = scripted(lambda t: 0.5 + 0.1 * min(t, 1.0), stops)
    assert ending.ended == "at-rest"
    assert scene.time == pytest.approx(1 / 0.75, abs=2 * LOOKS * 1e-3)


def test_an_oscillation_counts_as_rest():
    def wobble(t):
        return 0.5 + (0.1 * t if t < 1 else 0.1 + 0.4 * KEPT * 0.3 * np.sin(60 * t))

    _, ending, _ = scripted(wobble, lambda t: stops(t) or 3e-3)
    assert ending.ended == "at-rest"


def test_material_in_a_mould_that_is_lifted_later_is_not_at_rest():
    later = SimpleNamespace(
        touches=1,
        surface=SimpleNamespace(fastest=lambda t0, t1: 0.3 if t1 > 5 else 0.0, present=lambda t: True),
    )
    scene, ending, _ = scripted(lambda t: 0.2, stops, walls=[later])
    assert ending.ended
    assert scene.time > 5
    vanishes = SimpleNamespace(
        touches=1, surface=SimpleNamespace(fastest=lambda t0, t1: 0.0, present=lambda t: t < 5)
    )
    scene, ending, _ = scripted(lambda t: 0.2, stops, walls=[vanishes])
    assert scene.time > 5


def cake(until):
    return parse_case(CAKE | {"until": until})


def test_a_condition_ends_the_run_at_the_first_look_at_which_it_holds(tmp_path):
    case = cake({"spread_diameter": {"at_least": 0.49}, "at_most": 0.2})
    history = mpmkit.run(case, tmp_path / "run")
    found = summary(tmp_path / "run")
    assert found["stopped_because"] == history.attrs["stopped_because"] == "condition"
    assert found["ended_by"] == f"spread_diameter is {found['final_spread']:.6g}, at least 0.49"
    assert found["steps"] % LOOKS == 0
    assert found["simulated_time"] < 0.1
    long = mpmkit.run(cake(0.2))
    at_end = np.interp(found["simulated_time"], long.time, long.spread_diameter)
    assert found["final_spread"] == pytest.approx(at_end, abs=1e-4)
    before = np.interp(
        found["simulated_time"] - found["simulated_time"] / found["steps"] * LOOKS,
        long.time,
        long.spread_diameter,
    )
    assert before < 0.49 <= found["final_spread"]


def test_reaching_at_most_first_gives_a_warning(caplog):
    case = cake({"spread_diameter": {"at_least": 2}, "rest": True, "at_most": 0.02})
    with caplog.at_level(logging.WARNING, logger="mpmkit"):
        history = mpmkit.run(case)
    assert history.attrs["stopped_because"] == "finished"
    assert "the run has reached until.at_most, 0.02 s, before the material is at rest or" in caplog.text


@pytest.mark.parametrize(
    ("until", "sentence"),
    [
        ({"rest": True}, "until.at_most is missing; it must be a number above 0, in s"),
        ({"rest": 1, "at_most": 1}, "until.rest is 1; it must be true or false"),
        ({"spread_diametre": {"at_least": 1}, "at_most": 1}, "did you mean 'spread_diameter'?"),
        ({"momentum": {"at_least": 1}, "at_most": 1}, "until has the key 'momentum', which is not a scalar"),
        ({"height": 1, "at_most": 1}, "until.height is 1; it must be an object"),
        ({"height": {}, "at_most": 1}, "until.height: it must have at_least, at_most or both"),
        ({"height": {"at_least": 2, "at_most": 1}, "at_most": 1}, "no value is between them"),
        ("4", "until is \"4\"; it must be a number above 0, in s, or an object with the key 'at_most'"),
    ],
)
def test_a_wrong_until_has_its_sentence(until, sentence):
    with pytest.raises(CaseError) as error:
        cake(until)
    assert sentence in str(error.value)


def test_plan_and_a_study_take_at_most(tmp_path):
    case = cake({"rest": True, "at_most": 0.02})
    cost = plan(case, 1)
    assert cost["steps"] == plan(cake(0.02), 1)["steps"]
    assert any(
        "at rest, at the latest at t = 0.02 s: steps, memory and time are those of" in r
        for r in cost["remarks"]
    )
    data = CASE | {"until": {"kinetic_energy": {"at_least": 1e-9}, "at_most": 50.0}}
    dataset, _ = run(tmp_path, study(case=data, vary={"bodies.0.material.density": [1000, 1100]}))
    assert (dataset.fate == "finished").all()
    assert (dataset.steps == LOOKS).all()
    assert dataset.time[-1] == dataset.simulated_time.max() < 1
