"""``~`` in a path means the home folder wherever a path is typed, and nothing is written elsewhere."""

import json
import os
import shutil
from contextlib import nullcontext
from pathlib import Path

import matplotlib
import pytest
import xarray
from studies import CASE, Now, status

import mpmkit
from mpmkit.case import parse_case
from mpmkit.kernels.code_folders import cache_root
from mpmkit.output.netcdf import read_dataset, write_dataset


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A home folder with a case in it, beside the working directory."""
    home, here = tmp_path / "home", tmp_path / "here"
    home.mkdir()
    here.mkdir()
    # Caches of compiled code and of fonts stay where they are: making them again takes long.
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(cache_root().parent))
    monkeypatch.setenv("MPLCONFIGDIR", matplotlib.get_configdir())
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("USERPROFILE", str(home))
    monkeypatch.chdir(here)
    (home / "tiny.json").write_text(json.dumps(CASE | {"until": 0.002}), encoding="utf-8")
    (home / "s.json").write_text(json.dumps({"case": "tiny.json", "members": {"a": {}}}), encoding="utf-8")
    monkeypatch.setattr("mpmkit.cli.many_runs.ManyRuns.cluster", lambda how: nullcontext(Now()))
    yield home
    assert list(here.iterdir()) == []


def test_runs(home):
    assert status("run", "~/tiny.json", "--out", "~/x", "--quiet") == 0
    with xarray.open_dataset(home / "x" / "history.nc") as history:
        assert history.sizes["time"] >= 2
    assert (home / "x" / "summary.json").is_file()
    assert status("run", "--resume", "~/x", "--until", "0.004", "--quiet") == 0
    assert status("rerun", "~/x", "--out", "~/y", "--quiet") == 0
    assert status("report", "~/x") == 0
    assert {"x", "y"} < {path.name for path in home.iterdir()}


def test_studies_maps_and_plugins(home):
    assert status("study", "~/s.json", "--out", "~/s", "--quiet") == 0
    assert (home / "s" / "results.nc").is_file()
    (home / "spread.csv").write_text("time_s,spread_diameter_m\n0,0.4\n1,0.5\n")
    assert status("chart", "~/s", "--reference", "~/spread.csv", "--out", "~/c.png") == 0
    assert status("new-plugin", "wax", "--kind", "law", "--out", "~/mpmkit-wax") == 0
    assert (home / "c.png").is_file()
    assert (home / "mpmkit-wax" / "pyproject.toml").is_file()


def test_from_python(home):
    mpmkit.run(parse_case(CASE, ["until=0.002"]), "~/x")
    assert (home / "x" / "history.nc").is_file()


def test_a_folder_of_that_very_name(home, tmp_path):
    """``./~/x`` is no home folder, and the files of a run do not part there."""
    assert status("run", "~/tiny.json", "--out", "./~/x", "--quiet") == 0
    assert (tmp_path / "here" / "~" / "x" / "history.nc").is_file()
    assert not (home / "x").exists()
    shutil.rmtree(tmp_path / "here" / "~")


def test_a_dataset_is_written_where_it_was_said(home, tmp_path):
    os.mkdir("~")
    write_dataset(xarray.Dataset({"a": ("x", [1.0])}), Path("~/d.nc"))
    assert (tmp_path / "here" / "~" / "d.nc").is_file()
    assert read_dataset(Path("~/d.nc")).a.values.tolist() == [1.0]
    shutil.rmtree("./~")
