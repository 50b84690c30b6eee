"""Studies on processes of this machine: processes that die, interrupts, and the files afterwards."""

import json
import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time

import pytest
import xarray
from studies import CASE, DEADLY, Now, fragile, patient, status, study

from mpmkit.study import execute, load_study, members_of
from mpmkit.study.processes import cores
from mpmkit.study.store import Store

PATIENCE = 120
EXECUTE = sys.modules["mpmkit.study.execute"]
"""The module, whose name in its package is the function's."""


def wait_for(found, why):
    deadline = time.monotonic() + PATIENCE
    while not (value := found()):
        assert time.monotonic() < deadline, why
        time.sleep(0.02)
    return value


def is_gone(group):
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return True
    return False


@pytest.fixture
def scratch(tmp_path, monkeypatch):
    """Where workers have their files, which must be empty in the end."""
    path = tmp_path / "scratch"
    path.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(path))
    monkeypatch.setenv("TMPDIR", str(path))
    yield path
    assert list(path.glob("mpmkit-study-*")) == []


def test_a_worker_that_is_killed_loses_no_member(tmp_path, scratch, monkeypatch):
    """On a cluster, real runs survive this; see ``test_study_cluster``."""
    monkeypatch.setattr(EXECUTE, "run_member", patient)
    members, store = members_of(study(vary={"until": [1.0, 1.1]})), Store(tmp_path / "out")
    killed = []

    def kill():
        wait_for(lambda: list(scratch.glob("mpmkit-study-*/*/begun")), "no member has begun")
        killed.append(multiprocessing.active_children()[0])
        os.kill(killed[0].pid, signal.SIGKILL)
        killed[0].join(PATIENCE)
        (scratch / "killed").touch()

    killer = threading.Thread(target=kill)
    killer.start()
    execute(members, store, workers=2)
    killer.join()
    assert killed
    assert not multiprocessing.active_children()
    assert [store.outcome(member)["fate"] for member in members] == ["finished", "finished"]


def test_a_member_that_kills_its_process_each_time_is_given_up_and_no_other(tmp_path, scratch, monkeypatch):
    monkeypatch.setattr(EXECUTE, "run_member", fragile)
    given = study(vary={"until": [0.001, DEADLY, 0.002]})
    members, store = members_of(given), Store(tmp_path / "out")
    ended = []
    execute(members, store, workers=2, listen=lambda member, outcome: ended.append(member.title))
    assert sorted(ended) == ["0.001", "0.002", str(DEADLY)]
    outcomes = [store.outcome(member) for member in members]
    assert [outcome["fate"] for outcome in outcomes] == ["finished", "failed", "finished"]
    assert outcomes[1]["sentence"] == "the process that ran it died"


def test_as_many_at_once_as_the_cores_hold(tmp_path, monkeypatch):
    """Each member has its share of threads, and the machine no more than it has cores."""
    asked = []

    def processes(workers, each_alone):
        asked.append((workers, each_alone))
        return Now()

    monkeypatch.setattr(EXECUTE, "run_member", fragile)
    monkeypatch.setattr(EXECUTE, "processes", processes)
    monkeypatch.setattr(EXECUTE, "cores", lambda: 8)
    members = members_of(study(vary={"until": [0.001 * n for n in range(1, 7)]}))
    for number, options in enumerate([{"threads": 3}, {"threads": 16}, {"threads": 1}, {"workers": 4}]):
        execute(members, Store(tmp_path / str(number)), **options)
    assert asked == [(2, False), (1, False), (6, False), (4, False)]
    assert 1 <= cores() <= os.cpu_count()


@pytest.mark.parametrize("sent", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)])
def test_an_interrupted_study_keeps_what_has_finished_and_goes_on_from_there(tmp_path, scratch, sent):
    file = tmp_path / "s.json"
    content = {"case": CASE, "members": {"short": {}, "long": {"until": 1e4}, "next": {"until": 0.01}}}
    file.write_text(json.dumps(content), encoding="utf-8")
    command = [sys.executable, "-m", "mpmkit", "study", str(file), "--workers", "1"]
    process = subprocess.Popen(
        [*command, "--out", str(tmp_path / "out")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # Started in the background, this process may ignore the signal, and its children with it.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    try:
        wait_for(lambda: list(tmp_path.glob("out/members/short-*/member.json")), "no member has finished")
        wait_for(lambda: list(scratch.glob("mpmkit-study-*/*/run/history.nc")), "the second has not begun")
        # Ctrl-C reaches every process of a terminal.
        (os.killpg if sent == signal.SIGINT else os.kill)(process.pid, sent)
        shown, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 130, said
    assert said.splitlines()[-1] == (
        f"mpmkit: interrupted; the members that had finished are in '{tmp_path / 'out'}', and the same "
        "command continues from there"
    )
    assert "Traceback" not in said
    assert shown == ""
    wait_for(lambda: is_gone(process.pid), "a process of the study goes on")
    with xarray.open_dataset(tmp_path / "out" / "results.nc") as dataset:
        assert dataset.fate.values.tolist() == ["finished", "", ""]
    if sent == signal.SIGINT:
        goes_on(file, content)


def goes_on(file, content):
    """The same study, its long member made short: two are run."""
    content["members"]["long"]["until"] = 0.03
    file.write_text(json.dumps(content), encoding="utf-8")
    executor = Now()
    members = members_of(load_study(file))
    execute(members, Store(file.parent / "out"), executor=executor)
    assert [data["until"] for data in executor.ran] == [0.03, 0.01]


def test_study_on_the_command_line(tmp_path, scratch, monkeypatch, capfd):
    """Two processes, and what a person sees of them."""
    monkeypatch.chdir(tmp_path)
    changes = {"bodies.0.shape.upper": [0.201, 0.001]}
    content = {"case": CASE, "members": {"good": {}, "bad": changes}, "threads": 2}
    (tmp_path / "s.json").write_text(json.dumps(content), encoding="utf-8")
    assert status("study", "s.json", "--workers", "2") == 1
    shown, said = capfd.readouterr()
    assert shown.splitlines()[-1] == "results in runs/s; open runs/s/index.html in a browser"
    assert "bad: failed, 0.0 s: bodies.0.shape holds no particle" in said
    assert "good: finished, " in said
    assert said.splitlines()[-1] == (
        "mpmkit: 1 of 2 members (bad) failed; member.json of each in 'runs/s/members' says why, and the same "
        "command runs them again"
    )
    with xarray.open_dataset(next(tmp_path.glob("runs/s/members/good-*/history.nc"))) as history:
        assert json.loads(history.attrs["machine"])["threads"] == 2
