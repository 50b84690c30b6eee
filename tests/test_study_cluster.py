"""The same study on a cluster: a scheduler and two workers of Dask's, started here."""

import json
import os
import signal
import sys
import threading
import time

import pytest
import xarray
from studies import CASE, one_line, status

distributed = pytest.importorskip("distributed")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tmp").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))  # of the workers, which inherit it
    content = {"case": CASE, "vary": {"until": [2.0, 2.1, 2.2, 2.3]}}
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
    assert shown.count("| finished |") == 4
    with xarray.open_dataset(here / "runs" / "s" / "results.nc") as dataset:
        assert (dataset.fate == "finished").all()
        assert dataset.simulated_time.values == pytest.approx([2.0, 2.1, 2.2, 2.3])
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


def test_without_distributed_the_extra_is_named(here, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert status("study", "s.json", "--scheduler", "tcp://127.0.0.1:1") == 2
    assert "needs distributed: pip install distributed, or pip install '.[cluster]'" in one_line(capsys)
