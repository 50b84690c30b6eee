"""A fit on a cluster: a scheduler and two workers of Dask's, started here.

They are threads of this process, which costs a third of what processes cost; a study has those.
"""

import json

import pytest
from fits import block_of
from studies import Now, one_line, status

import mpmkit

distributed = pytest.importorskip("distributed")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "block.json").write_text(json.dumps(block_of(300)), encoding="utf-8")
    return tmp_path


def test_the_runs_of_a_cluster_give_the_same_result(here, capfd):
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, protocol="tcp", dashboard_address=None
    ) as cluster:
        assert status("fit", "block.json", "--scheduler", cluster.scheduler_address) == 0
    shown, _ = capfd.readouterr()
    assert shown.startswith("bodies.0.material.viscosity = ")
    found = json.loads((here / "runs/block/fit.json").read_text(encoding="utf-8"))
    alone = mpmkit.fit("block.json", "alone", executor=Now()).as_json()
    assert found == json.loads(json.dumps(alone))  # the same bits, whoever made the runs, in any order


def test_no_scheduler_is_one_sentence_and_writes_nothing(here, monkeypatch, capsys):
    monkeypatch.setattr("mpmkit.study.cluster.PATIENCE", 0.5)
    assert status("fit", "block.json", "--scheduler", "tcp://127.0.0.1:1") == 2
    assert "--scheduler tcp://127.0.0.1:1: no scheduler answers there: " in one_line(capsys)
    assert not (here / "runs").exists()
