"""The end of a run that goes wrong: the message names step and particle, and the records are complete."""

import json

import numpy as np
import pytest
import xarray

import mpmkit
from mpmkit.cli import main
from mpmkit.errors import GuardStop
from mpmkit.output import read_frame, read_frames
from mpmkit.solver.simulation import Simulation

FLYING = {
    "name": "flying",
    "space": "plane-strain",
    "until": 1.0,
    "gravity": [0, 0],
    "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}},
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.2], "upper": [0.6, 0.6]},
            "material": {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 10},
            "velocity": [2.0, 0.0],
        }
    ],
    "output": {"report": False, "history_interval": 0.02, "frame_interval": 0.05},
}


def status(*arguments):
    with pytest.raises(SystemExit) as stop:
        main([str(argument) for argument in arguments])
    return stop.value.code


def run(tmp_path, *arguments):
    (tmp_path / "case.json").write_text(json.dumps(FLYING), encoding="utf-8")
    return status("run", tmp_path / "case.json", "--out", tmp_path / "run", "--quiet", *arguments)


def kept(directory):
    """Summary, history and last frame of a run that was stopped."""
    summary = json.loads((directory / "summary.json").read_text())
    with xarray.open_dataset(directory / "history.nc") as file:
        history = file.load()
    frames = read_frames(directory / "frames")
    return summary, history, read_frame(frames[-1][1]), frames


def test_particles_that_leave_the_grid_stop_the_run(tmp_path, capsys):
    assert run(tmp_path) == 3
    (sentence,) = capsys.readouterr().err.splitlines()
    assert sentence.startswith("mpmkit: stopped at step ")
    assert "particle " in sentence
    assert "left the grid at x = 1" in sentence
    summary, history, frame, frames = kept(tmp_path / "run")
    assert summary["stopped_because"] == history.attrs["stopped_because"] == "particle-outside"
    assert f"step {summary['steps']}," in sentence
    assert 0.15 < history.time.values[-1] < 0.3
    assert len(history.time) > 5
    assert len(frames) > 3
    assert len(frame["position"]) == summary["particles"] == 64
    assert "left the grid" in (tmp_path / "run" / "run.log").read_text()


def test_what_is_not_finite_stops_the_run(tmp_path, capsys, monkeypatch):
    advance = Simulation.advance

    def spoil(self, *arguments):
        if self.steps == 10:
            self.particles.velocity[5] = np.nan
        return advance(self, *arguments)

    monkeypatch.setattr(Simulation, "advance", spoil)
    assert run(tmp_path) == 3
    (sentence,) = capsys.readouterr().err.splitlines()
    assert "stopped at step 1" in sentence
    assert "not finite" in sentence
    summary, history, _, _ = kept(tmp_path / "run")
    assert summary["stopped_because"] == "non-finite"
    assert history.attrs["stopped_because"] == "non-finite"
    assert np.isfinite(history.kinetic_energy.values[0])


def test_a_step_far_beyond_the_viscous_limit_is_stopped(tmp_path, capsys):
    arguments = ["--set", "bodies.0.material.viscosity=1e5", "--set", 'scheme.time_step.ignore=["viscous"]']
    arguments += ["--set", "scheme.time_step.fraction=1", "--set", "gravity=[0,-9.81]"]
    assert run(tmp_path, *arguments, "--set", 'grid.faces={"z_min":"stick","x_max":"stick"}') == 3
    assert "stopped at step " in capsys.readouterr().err
    summary, *_ = kept(tmp_path / "run")
    assert summary["stopped_because"] in ("non-finite", "particle-outside", "volume-ratio")


def test_a_guard_stop_says_step_and_particle():
    with pytest.raises(GuardStop) as stop:
        mpmkit.run(mpmkit.parse_case(FLYING))
    assert stop.value.guard == "particle-outside"
    assert stop.value.step > 5
    assert 0 <= stop.value.particle < 64


def test_a_run_in_memory_writes_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    history = mpmkit.run(mpmkit.parse_case(FLYING | {"until": 0.02}))
    assert history.time.values[-1] == pytest.approx(0.02)
    assert list(tmp_path.iterdir()) == []
