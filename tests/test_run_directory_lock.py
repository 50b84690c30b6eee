"""Two runs never write into one directory at once."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest
from test_cli import CASE as TINY

from mpmkit.cli import main
from mpmkit.errors import CaseError, OutputError
from mpmkit.output import RunDirectory

CASE = TINY | {"until": 1e4}
"""It runs until it is stopped."""


def refused(directory, overwrite=False):
    with pytest.raises(OutputError) as caught, RunDirectory(directory, overwrite).claimed():
        pass
    return str(caught.value)


def test_a_second_run_is_refused_while_the_first_is_at_work(tmp_path):
    with RunDirectory(tmp_path).claimed():
        assert "another run is writing there" in refused(tmp_path)
        (tmp_path / "case.json").write_text("{}")
        (tmp_path / "run.log").write_text("")
        assert "another run is writing there" in refused(tmp_path, overwrite=True)
        assert (tmp_path / "case.json").exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.json", "run.log"]
    with RunDirectory(tmp_path, overwrite=True).claimed():
        pass


def test_a_run_that_fails_gives_the_directory_back(tmp_path):
    with pytest.raises(ZeroDivisionError), RunDirectory(tmp_path).claimed():
        raise ZeroDivisionError
    with RunDirectory(tmp_path).claimed():
        pass


def test_a_lock_that_nobody_holds_does_not_block(tmp_path):
    (tmp_path / ".lock").write_text("")
    with RunDirectory(tmp_path).claimed():
        pass


def test_a_file_of_the_users_that_is_called_like_the_lock_stays(tmp_path):
    (tmp_path / ".lock").write_text("of another program")
    with RunDirectory(tmp_path).claimed():
        pass
    assert (tmp_path / ".lock").read_text() == "of another program"


def test_what_is_not_a_run_gets_no_lock_either(tmp_path):
    (tmp_path / "thesis.tex").write_text("")
    for overwrite in (False, True):
        with pytest.raises(CaseError), RunDirectory(tmp_path, overwrite).claimed():
            pass
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_two_processes_and_one_that_is_killed(tmp_path, capsys):
    (tmp_path / "case.json").write_text(json.dumps(CASE), encoding="utf-8")
    out = tmp_path / "run"
    arguments = ["run", str(tmp_path / "case.json"), "--out", str(out), "--quiet", "--overwrite"]
    first = subprocess.Popen([sys.executable, "-m", "mpmkit", *arguments])
    try:
        deadline = time.monotonic() + 60
        while not (out / "history.nc").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        with pytest.raises(SystemExit) as stop:
            main(arguments)
        assert stop.value.code == 4
        (sentence,) = capsys.readouterr().err.splitlines()
        assert "another run is writing there" in sentence
        assert first.poll() is None
        os.kill(first.pid, signal.SIGKILL)
        first.wait(timeout=30)
    finally:
        first.kill()
        first.wait()
    assert (out / ".lock").exists()
    with pytest.raises(SystemExit) as stop:
        main([*arguments, "--until", "1e-3"])
    assert stop.value.code == 0
    assert not (out / ".lock").exists()
