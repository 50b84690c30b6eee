"""Runs that stop for other reasons than the flow: a plug-in that raises, a full disk."""

import json
import subprocess
import sys
from typing import ClassVar

import numpy as np
import pytest
import xarray

import mpmkit
from mpmkit.case import parse_case
from mpmkit.contracts import GeneralisedNewtonianLaw
from mpmkit.errors import CaseError, GuardStop, OutputError
from mpmkit.output import History, read_frames
from mpmkit.plan import plan
from mpmkit.registry import Registered, Registry, installed
from mpmkit.solver.simulation import Simulation

CASE = {
    "name": "failing",
    "space": "plane-strain",
    "until": 0.05,
    "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]},
            "material": {"law": "fragile", "density": 1000, "sound_speed": 20},
        }
    ],
    "output": {"report": False, "history_interval": 0.005},
}


PARTICLES = 64


class Fragile(GeneralisedNewtonianLaw):
    """Fails once it has been asked ``bears`` times."""

    name = "fragile"
    api_version = 2
    citation = "none"
    bears: ClassVar[int] = 20
    asked: ClassVar[int] = 0

    def apparent_viscosity(self, shear_rate):
        Fragile.asked += 1
        if Fragile.asked > Fragile.bears:
            raise KeyError("yield surface")
        return np.full_like(shear_rate, 10.0)


class Misshapen(Fragile):
    """Returns what the framework cannot use."""

    name = "misshapen"

    def apparent_viscosity(self, shear_rate):
        return "honey" if len(shear_rate) == PARTICLES else np.full_like(shear_rate, 10.0)


def case(law=Fragile, **changes):
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("law", law, "tests", "1", "law")], [])
    data = json.loads(json.dumps(CASE))
    data["bodies"][0]["material"]["law"] = law.name
    return parse_case(data | changes, registry=registry)


@pytest.fixture(autouse=True)
def fresh(monkeypatch):
    monkeypatch.setattr(Fragile, "asked", 0)


def kept(directory):
    with xarray.open_dataset(directory / "history.nc") as file:
        history = file.load()
    log = (directory / "run.log").read_text()
    return json.loads((directory / "summary.json").read_text()), history, log


def test_a_plugin_that_raises_stops_the_run_as_a_guard_does(tmp_path):
    with pytest.raises(GuardStop) as stop:
        mpmkit.run(case(), tmp_path)
    assert stop.value.exit_status == 3
    assert f"stopped at step {stop.value.step}, t = " in str(stop.value)
    assert "the plug-in 'fragile' (law) raised KeyError: 'yield surface' (test_run_failures.py, line " in str(
        stop.value
    )
    assert isinstance(stop.value.__cause__, KeyError)
    summary, history, log = kept(tmp_path)
    assert summary["stopped_because"] == history.attrs["stopped_because"] == "plug-in-error"
    assert summary["steps"] == stop.value.step > 10
    assert len(history.time) > 1
    assert len(read_frames(tmp_path / "frames")) > 1
    assert str(stop.value) in log
    assert "Traceback" in log


def test_what_a_plugin_makes_the_framework_raise_is_its_own_fault():
    with pytest.raises(GuardStop, match=r"the plug-in 'misshapen' \(law\) raised "):
        mpmkit.run(case(Misshapen))


def test_a_plugin_that_raises_before_the_first_step(tmp_path, monkeypatch):
    given = case()
    monkeypatch.setattr(Fragile, "bears", 0)
    for attempt in (lambda: mpmkit.run(given, tmp_path / "run"), lambda: plan(given)):
        with pytest.raises(GuardStop, match=r"stopped at step 0, .* the plug-in 'fragile'"):
            attempt()
    assert not (tmp_path / "run").exists()


def test_a_fault_of_the_framework_is_not_blamed_on_a_plugin(tmp_path, monkeypatch):
    def fail(self):
        raise KeyError("ours")

    monkeypatch.setattr(Simulation, "check", fail)
    with pytest.raises(KeyError):
        mpmkit.run(case(bodies=[CASE["bodies"][0] | {"material": newtonian()}]), tmp_path)
    summary, _, log = kept(tmp_path)
    assert summary["stopped_because"] == "error"
    assert "KeyError: 'ours'" in log
    assert "Traceback" in log


def newtonian():
    return {"law": "newtonian", "viscosity": 1, "density": 1000, "sound_speed": 20}


def test_a_history_that_cannot_be_written_leaves_log_and_summary(tmp_path, monkeypatch):
    write = History.write

    def full(self, path):
        if len(self) > 3:
            raise OutputError(f"cannot write '{path}': No space left on device")
        write(self, path)

    monkeypatch.setattr(History, "write", full)
    monkeypatch.setattr("mpmkit.output.history.FLUSH_INTERVAL", 0)
    monkeypatch.setattr("mpmkit.output.history.FLUSH_PAUSE", 0)
    with pytest.raises(OutputError, match="No space left"):
        mpmkit.run(case(bodies=[CASE["bodies"][0] | {"material": newtonian()}]), tmp_path)
    summary, history, log = kept(tmp_path)
    assert summary["stopped_because"] == "output-error"
    assert summary["final_spread"] is not None
    assert len(history.time) == 3
    assert "ERROR   cannot write" in log


def test_a_file_size_limit(tmp_path):
    """As ``ulimit -f`` sets it, and for real."""
    (tmp_path / "case.json").write_text(
        json.dumps(CASE | {"bodies": [CASE["bodies"][0] | {"material": newtonian()}]})
    )
    command = f"ulimit -f 12; exec {sys.executable} -m mpmkit run case.json --out run --threads 1"
    done = subprocess.run(["bash", "-c", command], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 4, done.stderr
    assert done.stderr.splitlines()[-1].startswith("mpmkit: cannot write 'run/history.nc': ")
    assert "Traceback" not in done.stderr
    assert json.loads((tmp_path / "run/summary.json").read_text())["stopped_because"] == "output-error"
    assert "ERROR   cannot write" in (tmp_path / "run/run.log").read_text()


@pytest.mark.parametrize("threads", [0, -3])
def test_no_threads_are_refused(tmp_path, threads):
    for out in (None, tmp_path / "run"):
        with pytest.raises(CaseError, match=f"threads is {threads}; it must be"):
            mpmkit.run(case(), out, threads=threads)
    assert not (tmp_path / "run").exists()
