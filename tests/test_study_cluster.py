"""The same study on a cluster: a scheduler and two workers of Dask's, started here."""

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest
import xarray
from studies import CASE, one_line, status

from mpmkit.study import cluster as cluster_module

distributed = pytest.importorskip("distributed")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tmp").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))  # of the workers, which inherit it
    content = {"case": CASE, "vary": {"until": [0.9, 1.0, 1.1]}}
    (tmp_path / "s.json").write_text(json.dumps(content), encoding="utf-8")
    return tmp_path


def test_a_worker_is_killed_in_mid_study_and_the_study_completes(here, capfd):
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        before, busy = client.run(os.getpid), []
        assert len(set(before.values())) == 2

        def kill():
            deadline = time.monotonic() + 120
            while not list((here / "tmp").glob("*/run/history.nc")) and time.monotonic() < deadline:
                time.sleep(0.02)
            # A worker that holds a member; the other one may be waiting still.
            busy.extend(address for address, tasks in client.processing().items() if tasks)
            os.kill(before[busy[0]], signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        assert status("study", "s.json", "--scheduler", cluster.scheduler_address) == 0
        killer.join()
        assert before[busy[0]] not in client.run(os.getpid).values()
    shown, _ = capfd.readouterr()
    assert shown.count("| finished |") == 3
    with xarray.open_dataset(here / "runs" / "s" / "results.nc") as dataset:
        assert (dataset.fate == "finished").all()
        assert dataset.simulated_time.values == pytest.approx([0.9, 1.0, 1.1])
        assert (dataset.wall_seconds > 0).all()


@pytest.mark.parametrize(
    ("address", "sentence"),
    [
        ("tcp://127.0.0.1:1", "--scheduler tcp://127.0.0.1:1: no scheduler answers there: "),
        ("nowhere://at-all", "--scheduler nowhere://at-all: no scheduler answers there: "),
    ],
)
def test_no_scheduler_is_one_sentence_and_writes_nothing(here, address, sentence, monkeypatch, capsys):
    monkeypatch.setattr("mpmkit.study.cluster.PATIENCE", 0.5)
    assert status("study", "s.json", "--scheduler", address) == 2
    assert sentence in one_line(capsys)
    assert not (here / "runs").exists()


def test_a_scheduler_is_not_waited_for_long():
    assert cluster_module.PATIENCE <= 5


def mpmkit(*arguments, here):
    return subprocess.Popen(
        [sys.executable, "-m", "mpmkit", *arguments],
        cwd=here,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Started in the background, this process may ignore the signal, and its children with it.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )


def test_an_interrupt_while_the_scheduler_is_looked_for_is_one_line(here):
    """It listens, so that it is there, and never answers."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        process = mpmkit("study", "s.json", "--scheduler", address, here=here)
        server.settimeout(120)
        with server.accept()[0]:
            time.sleep(0.3)
            process.send_signal(signal.SIGINT)
            _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said.strip() == "mpmkit: interrupted"
    assert not (here / "runs").exists()


def test_the_scheduler_dies_in_mid_study(here):
    """No traceback, no success: the members without a result are named, and the same command goes on."""
    content = {"case": CASE, "vary": {"until": [1e4, 2e4]}}  # s, more than the test takes
    (here / "s.json").write_text(json.dumps(content), encoding="utf-8")
    listening = here / "scheduler.json"
    servers = [
        subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.dask_{what}", *options, "--no-dashboard",
             "--scheduler-file", str(listening)],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        for what, options in (
            ("scheduler", ["--host", "127.0.0.1", "--port", "0"]),
            ("worker", ["--nthreads", "1", "--no-nanny", "--death-timeout", "60"]),
        )
    ]  # fmt: skip
    try:
        wait_for(listening.exists)
        address = json.loads(listening.read_text())["address"]
        process = mpmkit("study", "s.json", "--scheduler", address, here=here)
        wait_for(lambda: list((here / "tmp").glob("*/run/history.nc")))
        servers[0].kill()
        _, said = process.communicate(timeout=60)
    finally:
        for server in servers:
            server.kill()
            server.wait()
    assert process.returncode == 1
    assert "Traceback" not in said
    assert said.splitlines()[-1].startswith(f"mpmkit: the scheduler {address} does not answer any more: ")
    assert said.rstrip().endswith(" 2 of 2 members (10000.0, 20000.0); run the same study again to continue")
    with xarray.open_dataset(here / "runs" / "s" / "results.nc") as dataset:
        assert set(dataset.fate.values) == {""}  # no member failed because of it
    assert not list(here.glob("runs/s/members/*/member.json"))


def wait_for(condition):
    deadline = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def test_without_distributed_the_extra_is_named(here, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert status("study", "s.json", "--scheduler", "tcp://127.0.0.1:1") == 2
    assert "needs distributed: pip install distributed, or pip install '.[cluster]'" in one_line(capsys)
