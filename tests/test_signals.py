"""Signals of batch systems lead to a checkpoint; a late signal does not change a finished run."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import mpmkit
from mpmkit import report
from mpmkit.case import parse_case
from mpmkit.cli import main
from mpmkit.errors import OutputError, Undrawn
from mpmkit.output import RunDirectory
from mpmkit.output.checkpoints import Checkpoints
from mpmkit.running import interrupts
from mpmkit.running.saver import Saver
from mpmkit.solver.simulation import Simulation

CASE = {
    "space": "plane-strain",
    "until": 0.05,
    "grid": {
        "cell_size": 0.1,
        "domain": {"x": [0, 1], "z": [0, 1]},
        "faces": {"x_min": "slip", "x_max": "slip", "z_min": "slip"},
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]},
            "material": {"law": "newtonian", "density": 1000, "viscosity": 10, "sound_speed": 20},
        }
    ],
}
NAMES = ["SIGTERM", "SIGHUP", "SIGXCPU", "SIGUSR1"]


@pytest.fixture
def signals():
    """The handlers are as they were behind the test."""
    before = {number: signal.getsignal(number) for number in interrupts.SIGNALS}
    for number in interrupts.SIGNALS:
        signal.signal(number, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def on_step(monkeypatch, step, do):
    advance = Simulation.advance

    def advanced(self, *arguments):
        done = advance(self, *arguments)
        if self.steps == step:
            do()
        return done

    monkeypatch.setattr(Simulation, "advance", advanced)


def run(tmp_path, **changes) -> int:
    (tmp_path / "case.json").write_text(json.dumps(CASE | changes), encoding="utf-8")
    with pytest.raises(SystemExit) as stop:
        main(["run", str(tmp_path / "case.json"), "--out", str(tmp_path / "run"), "--threads", "1"])
    return stop.value.code


@pytest.mark.parametrize("name", NAMES)
def test_each_leaves_a_checkpoint(tmp_path, monkeypatch, capsys, signals, name):
    on_step(monkeypatch, 5, lambda: os.kill(os.getpid(), getattr(signal, name)))
    assert run(tmp_path, output={"report": False}) == 130
    assert "go on with: mpmkit run --resume " in capsys.readouterr().err
    assert len(Checkpoints(tmp_path / "run/checkpoints").paths()) == 1
    monkeypatch.undo()
    with pytest.raises(SystemExit) as stop:
        main(["run", "--resume", str(tmp_path / "run"), "--quiet"])
    assert stop.value.code == 0


def test_what_is_ignored_stays_ignored(tmp_path, monkeypatch, signals):
    """As under nohup."""
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    on_step(monkeypatch, 5, lambda: os.kill(os.getpid(), signal.SIGHUP))
    assert run(tmp_path, output={"report": False}) == 0


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_process_that_gets_the_signal_of_a_time_limit(tmp_path):
    (tmp_path / "case.json").write_text(json.dumps(CASE | {"until": 1e4}))
    command = [
        sys.executable,
        "-m",
        "mpmkit",
        "run",
        "case.json",
        "--out",
        "run",
        "--checkpoint-every",
        "0.1s",
    ]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    try:
        deadline = time.monotonic() + 120
        while not (tmp_path / "run/checkpoints").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGXCPU)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 130, said
    assert said.splitlines()[-1].endswith("go on with: mpmkit run --resume run")


def drawing_interrupted(monkeypatch):
    def interrupted(directory):
        raise KeyboardInterrupt

    monkeypatch.setattr(report, "write_report", interrupted)


def test_a_signal_while_drawing_leaves_a_finished_run_finished(tmp_path, monkeypatch, capsys, signals):
    drawing_interrupted(monkeypatch)
    assert run(tmp_path) == 0
    said = capsys.readouterr().err
    assert "interrupted" not in said
    assert f"warning: the run has ended and its results are in '{tmp_path / 'run'}'" in said
    assert f"draw them with: mpmkit report {tmp_path / 'run'}" in said
    assert json.loads((tmp_path / "run/summary.json").read_text())["stopped_because"] == "finished"
    monkeypatch.undo()
    with pytest.raises(SystemExit) as stop:
        main(["report", str(tmp_path / "run")])
    assert stop.value.code == 0
    drawn = capsys.readouterr().out.splitlines()
    assert drawn == [str(path) for path in map(Path, drawn) if path.exists()]
    assert tmp_path / "run/report/outline.png" in map(Path, drawn)


def test_a_signal_during_the_last_step_does_not_stop_what_is_done(tmp_path, monkeypatch, capsys, signals):
    """The run is over when it is asked for: it is finished, and draws nothing more."""
    steps = mpmkit.run(parse_case(CASE)).sizes["time"] - 1  # a row a step: rows are closer than steps
    on_step(monkeypatch, steps, lambda: os.kill(os.getpid(), signal.SIGTERM))
    assert run(tmp_path) == 0
    assert json.loads((tmp_path / "run/summary.json").read_text())["steps"] == steps
    assert "draw them with: mpmkit report " in capsys.readouterr().err
    assert not (tmp_path / "run/report").exists()


def test_a_calling_program_gets_an_interrupt_while_drawing(tmp_path, monkeypatch):
    drawing_interrupted(monkeypatch)
    with pytest.raises(Undrawn, match="mpmkit report"):
        mpmkit.run(parse_case(CASE), tmp_path / "run")


@pytest.mark.parametrize("content", [None, b"no history"])
def test_there_must_be_a_run_to_draw(tmp_path, capsys, content):
    if content is not None:
        (tmp_path / "history.nc").write_bytes(content)
    with pytest.raises(SystemExit) as stop:
        main(["report", str(tmp_path)])
    assert stop.value.code == 2
    assert capsys.readouterr().err.startswith(f"mpmkit: '{tmp_path}' does not hold the results of a run")


# --- Checkpoints that cannot be written


def full_after(monkeypatch, count):
    """A disk that is full once so many checkpoints are on it."""
    write, written = Checkpoints.write, []

    def limited(self, step, *arguments):
        if len(written) >= count:
            raise OutputError("cannot write 'x': No space left on device")
        written.append(step)
        write(self, step, *arguments)

    monkeypatch.setattr(Checkpoints, "write", limited)
    return written


def test_a_checkpoint_that_cannot_be_written_does_not_end_the_run(tmp_path, monkeypatch, caplog):
    written = full_after(monkeypatch, 1)
    case = parse_case(CASE | {"output": {"report": False}})
    history = mpmkit.run(case, tmp_path / "run", checkpoint_every=1e-9)
    assert history.attrs["stopped_because"] == "finished"
    (left,) = Checkpoints(RunDirectory(tmp_path / "run").checkpoints).paths()
    assert left.name == f"step_{written[0]:012d}.checkpoint"
    assert "cannot write 'x': No space left on device; the one before it stays" in caplog.text


def test_a_checkpoint_that_does_not_fit_into_memory_does_not_end_the_run(tmp_path, monkeypatch, caplog):
    def too_large(self):
        raise MemoryError("unable to allocate")

    monkeypatch.setattr(Saver, "save", too_large)
    case = parse_case(CASE | {"output": {"report": False}})
    assert mpmkit.run(case, tmp_path, checkpoint_every=1e-9).attrs["stopped_because"] == "finished"
    assert "no checkpoint at t = " in caplog.text
