"""A run that was stopped in any way continues from its directory to the same bits as a run without a stop."""

from __future__ import annotations

import hashlib
import io
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray
from coarse import CASES, COARSE

import mpmkit
from mpmkit.case import load_case
from mpmkit.cli import main
from mpmkit.errors import CaseError
from mpmkit.output.checkpoints import MAGIC, Checkpoints
from mpmkit.running import resume as resume_module
from mpmkit.running.runner import resume
from mpmkit.solver.simulation import Simulation

# --- Interrupted runs


def run(tmp_path, name="run", **settings):
    case = load_case(CASES / "slump_fast.json", [*COARSE["slump_fast"], "until=0.3", "output.report=false"])
    return case, tmp_path / name, settings


def stop_after(monkeypatch, seconds):
    """An interrupt that comes once the simulation has come to a time."""
    advance = Simulation.advance

    def advanced(self, *arguments):
        done = advance(self, *arguments)
        if self.time > seconds:
            monkeypatch.setattr(Simulation, "advance", advance)
            os.kill(os.getpid(), signal.SIGINT)
        return done

    monkeypatch.setattr(Simulation, "advance", advanced)


@pytest.fixture(scope="module")
def stopped_once(tmp_path_factory):
    """The folder of two runs: one that was interrupted at 0.1 of 0.3 s, and one that was not."""
    folder = tmp_path_factory.mktemp("stopped")
    case, directory, _ = run(folder)
    mpmkit.run(case, folder / "whole")
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(signal, "getsignal", lambda number: signal.default_int_handler)
        stop_after(patched, 0.1)
        with pytest.raises(KeyboardInterrupt, match=r"go on with: mpmkit run --resume"):
            mpmkit.run(case, directory)
    signal.signal(signal.SIGINT, before)
    return folder


@pytest.fixture
def stopped(stopped_once, tmp_path):
    """The directory of a run that was interrupted, beside that of one that was not: a copy for each test."""
    for name in ("run", "whole"):
        shutil.copytree(stopped_once / name, tmp_path / name)
    return tmp_path / "run"


def same_histories(a: Path, b: Path):
    with xarray.open_dataset(a / "history.nc") as one, xarray.open_dataset(b / "history.nc") as other:
        xarray.testing.assert_identical(one.drop_attrs(), other.drop_attrs())
    frames = sorted(path.name for path in (a / "frames").iterdir())
    assert frames == sorted(path.name for path in (b / "frames").iterdir())
    for name in frames:
        assert (a / "frames" / name).read_bytes() == (b / "frames" / name).read_bytes(), name


def test_an_interrupted_run_goes_on_and_leaves_what_an_uninterrupted_one_does(stopped):
    assert json.loads((stopped / "summary.json").read_text())["stopped_because"] == "interrupted"
    history = resume(stopped)
    assert history.attrs["stopped_because"] == "finished"
    same_histories(stopped, stopped.with_name("whole"))
    assert len(Checkpoints(stopped / "checkpoints").paths()) == 1  # from which a longer run can go on
    assert "goes on after step" in (stopped / "run.log").read_text()
    with pytest.raises(CaseError, match="has finished: there is nothing to go on with"):
        resume(stopped)


def test_particles_that_came_on_the_way_are_in_the_history(tmp_path, monkeypatch):
    """Rows with increasing numbers of particles survive the checkpoint."""
    case = load_case(
        CASES / "slump_fast.json",
        [*COARSE["slump_fast"], "until=0.4", "output.report=false", 'output.particle_history=["velocity"]'],
    )
    monkeypatch.setattr(signal, "getsignal", lambda number: signal.default_int_handler)
    mpmkit.run(case, tmp_path / "whole")
    stop_after(monkeypatch, 0.3)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            mpmkit.run(case, tmp_path / "run")
    finally:
        signal.signal(signal.SIGINT, before)
    resume(tmp_path / "run")
    same_histories(tmp_path / "run", tmp_path / "whole")


def damaged(directory: Path, how: str):
    """Add a newer checkpoint that is not whole."""
    (last,) = Checkpoints(directory / "checkpoints").paths()
    content = last.read_bytes()
    if how == "cut off":
        content = content[: len(content) // 2]
    elif how == "one bit":
        content = content[:-100] + bytes([content[-100] ^ 1]) + content[-99:]
    elif how == "empty":
        content = b""
    newer = last.with_name("step_999999999999.checkpoint")
    newer.write_bytes(content)
    return last, newer


@pytest.mark.parametrize("how", ["cut off", "one bit", "empty"])
def test_a_damaged_checkpoint_is_noticed_and_the_one_before_is_used(stopped, how, caplog):
    damaged(stopped, how)
    resume(stopped)
    assert "the one before it is used" in caplog.text
    same_histories(stopped, stopped.with_name("whole"))


def test_a_run_with_damaged_checkpoints_only_is_refused_and_unchanged(stopped):
    last, _ = damaged(stopped, "empty")
    last.write_bytes(last.read_bytes()[:1000])
    before = {path: path.read_bytes() for path in stopped.rglob("*") if path.is_file()}
    with pytest.raises(CaseError, match="has no checkpoint to go on from"):
        resume(stopped)
    assert {path: path.read_bytes() for path in stopped.rglob("*") if path.is_file()} == before


def test_nothing_in_a_checkpoint_is_unpickled(stopped, tmp_path):
    """An array of objects could run code: it is refused, also in a file with a right checksum."""

    class Evil:
        def __reduce__(self):
            return os.mkdir, (str(tmp_path / "executed"),)

    content = io.BytesIO()
    np.savez(content, words=np.array([Evil()], dtype=object))
    body = content.getvalue()
    head = MAGIC + hashlib.sha256(body).hexdigest().encode() + b"\n"
    for path in Checkpoints(stopped / "checkpoints").paths():
        path.write_bytes(head + body)
    with pytest.raises(CaseError, match="has no checkpoint"):
        resume(stopped)
    assert not (tmp_path / "executed").exists()


def test_the_last_two_are_kept(tmp_path):
    checkpoints = Checkpoints(tmp_path / "checkpoints")
    for step in (1, 10, 100, 1000):
        checkpoints.write(step, {"x": np.arange(3.0)}, {"step": step})
    assert [path.name for path in checkpoints.paths()] == [
        "step_000000001000.checkpoint",
        "step_000000000100.checkpoint",
    ]
    arrays, words = checkpoints.newest()
    np.testing.assert_array_equal(arrays["x"], [0, 1, 2])
    assert words == {"step": 1000}


# --- Another run is refused, with the difference named


def test_another_case_in_the_directory(stopped):
    data = json.loads((stopped / "case.json").read_text())
    data["bodies"][0]["material"]["yield_stress"] = 200.0
    (stopped / "case.json").write_text(json.dumps(data))
    with pytest.raises(CaseError, match=r"case\.bodies\.0\.material\.yield_stress was 188\.91 and is 200"):
        resume(stopped)


def test_another_case_on_the_command_line(stopped):
    other = load_case(stopped / "case.json", ["scheme.order=usf"])
    with pytest.raises(CaseError, match=r'scheme\.order\.name was "usl" and is "usf"'):
        resume(stopped, case=other)
    assert resume(stopped, case=load_case(stopped / "case.json")).attrs["stopped_because"] == "finished"


@pytest.mark.parametrize("what", ["mpmkit", "numba", "plugins"])
def test_other_versions(stopped, what, monkeypatch):
    identity = resume_module.identity

    def other(case):
        found = identity(case)
        if what == "plugins":
            found["plugins"]["order 'usl'"] = "mpmkit 9.9"
        else:
            found[what] = "9.9"
        return found

    monkeypatch.setattr(resume_module, "identity", other)
    named = "plugins\\.order 'usl'" if what == "plugins" else what
    with pytest.raises(CaseError, match=rf'{named} was ".*" and is ".*9\.9"'):
        resume(stopped)


def test_a_directory_without_a_run(tmp_path):
    with pytest.raises(CaseError, match=r"is not the directory of a run: it has no case\.json"):
        resume(tmp_path)


# --- kill -9


def command(*arguments):
    return [sys.executable, "-m", "mpmkit", *map(str, arguments)]


KILLED = {
    "slump_fast": ["until=8"],
    "slump_lifted": [
        "until=4",
        "walls.mould.surface.motion.velocity=[0, 0.05]",
        'grid.domain={"r": [0, 0.6], "z": [0, 0.32]}',
    ],
}
"""Cases that are killed: one of a falling body, and one of a wall that moves, and is touched, to the end."""


def kill_again_and_again(tmp_path, name, times, seed, *more_changes):
    """The run of a slump, killed at random and resumed, until it is finished."""
    chosen = random.Random(seed)
    changes = [*COARSE[name], *KILLED[name], "output.report=false", *more_changes]
    case = load_case(CASES / f"{name}.json", changes)
    mpmkit.run(case, tmp_path / "whole", threads=1)
    directory, killed = tmp_path / "run", 0
    checkpoints = Checkpoints(directory / "checkpoints")
    overrides = [word for change in changes for word in ("--set", change)]
    more = [CASES / f"{name}.json", *overrides, "--threads", 1, "--out", directory]
    while True:
        before = checkpoints.paths()
        process = subprocess.Popen(command("run", *more, "--quiet", "--checkpoint-every", "0.02s"))
        if killed == times:
            assert process.wait(300) == 0
            break
        while process.poll() is None and checkpoints.paths() == before:
            time.sleep(0.01)
        time.sleep(chosen.uniform(0.0, 0.1))
        process.kill()  # SIGKILL: it hears nothing of it
        process.wait()
        if (directory / "summary.json").exists():  # it was through before
            break
        killed += 1
        if (directory / "history.nc").exists():
            with xarray.open_dataset(directory / "history.nc") as history:
                assert np.isfinite(history.spread_diameter.values).all()
        more = ["--resume", directory]
    same_histories(directory, tmp_path / "whole")
    return killed


def test_killed_and_resumed(tmp_path):
    assert kill_again_and_again(tmp_path, "slump_fast", 1, 1, "until=4") == 1


@pytest.mark.slow
@pytest.mark.parametrize("name", KILLED)
def test_killed_and_resumed_twenty_times(tmp_path, name):
    total = 0
    for seed in range(20):
        total += kill_again_and_again(tmp_path / str(seed), name, times=20 - total, seed=seed)
        if total >= 20:
            break
    assert total >= 20


# --- rerun


def test_a_run_is_repeated_from_its_directory(tmp_path):
    case, directory, _ = run(tmp_path)
    mpmkit.run(case, directory)
    done = subprocess.run(command("rerun", directory, "--quiet"), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("the same bits")
    same_histories(directory, tmp_path / "run-rerun")


def test_a_rerun_says_what_differs(tmp_path, capsys):
    case, directory, _ = run(tmp_path)
    mpmkit.run(case, directory)
    data = json.loads((directory / "case.json").read_text())
    data["bodies"][0]["material"]["consistency"] *= 1 + 1e-12
    (directory / "case.json").write_text(json.dumps(data))
    with pytest.raises(SystemExit) as stop:
        main(["rerun", str(directory), "--quiet"])
    assert stop.value.code == 1
    assert "not the same: " in capsys.readouterr().out
