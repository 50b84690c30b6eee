"""A finished run continues to a later time, with the same result as a long run from the start."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray

import mpmkit
from mpmkit.case import load_case
from mpmkit.cli import main
from mpmkit.errors import CaseError
from mpmkit.output.checkpoints import Checkpoints
from mpmkit.running.runner import resume

CASE = Path(__file__).parents[1] / "cases/slump_fast.json"
COARSE = [
    "grid.cell_size=0.04",
    'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}',
    "output.report=false",
    "output.history_interval=0.00025",  # shorter than a step, and a multiple of it is the first end
    "output.frame_interval=0.01",
]


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A run to 0.1 s, and one to 0.15 s beside it."""
    place = tmp_path_factory.mktemp("longer")
    for name, until in (("short", 0.1), ("long", 0.15)):
        mpmkit.run(load_case(CASE, [*COARSE, f"until={until}"]), place / name)
    return place


def same(a: Path, b: Path):
    with xarray.open_dataset(a / "history.nc") as one, xarray.open_dataset(b / "history.nc") as other:
        xarray.testing.assert_identical(one.drop_attrs(), other.drop_attrs())
        assert json.loads(one.attrs["case"]) == json.loads(other.attrs["case"])
    assert json.loads((a / "case.json").read_text()) == json.loads((b / "case.json").read_text())
    frames = sorted(path.name for path in (a / "frames").iterdir())
    assert frames == sorted(path.name for path in (b / "frames").iterdir())
    for name in frames:
        assert (a / "frames" / name).read_bytes() == (b / "frames" / name).read_bytes(), name


def test_the_bits_are_those_of_a_run_that_was_as_long_from_the_start(finished, tmp_path):
    """The last step of the short run was cut to end at 0.1 s: the longer one has none that ends there."""
    shutil.copytree(finished / "short", tmp_path / "run")
    history = resume(tmp_path / "run", until=0.15)
    assert history.time[-1] == pytest.approx(0.15, rel=1e-9)
    assert not np.isclose(history.time.values, 0.1, rtol=1e-9).any()
    same(tmp_path / "run", finished / "long")
    summary = json.loads((tmp_path / "run/summary.json").read_text())
    assert summary["steps"] == json.loads((finished / "long/summary.json").read_text())["steps"]
    assert len(Checkpoints(tmp_path / "run/checkpoints").paths()) == 1


def test_on_the_command_line_in_two_goes(finished, tmp_path):
    """With and without the case file; what is left out of it is as it was."""
    run = shutil.copytree(finished / "short", tmp_path / "run")
    settings = [argument for change in COARSE for argument in ("--set", change)]
    for arguments in (["--until", "0.12"], [str(CASE), *settings, "--set", "until=0.12", "--until", "0.15"]):
        with pytest.raises(SystemExit) as stop:
            main(["run", "--resume", str(run), *arguments, "--quiet"])
        assert stop.value.code == 0
    same(run, finished / "long")


@pytest.mark.parametrize("until", [0.05, float("inf"), float("nan")])
def test_only_a_later_time_will_do(finished, until):
    before = {path: path.read_bytes() for path in (finished / "short").rglob("*") if path.is_file()}
    with pytest.raises(CaseError, match=r"until is .* ends at 0\.1 s, and can only go on to a later time"):
        resume(finished / "short", until=until)
    with pytest.raises(CaseError, match=r"has finished: .*; --until T with a T above 0\.1 s makes it longer"):
        resume(finished / "short")
    assert {path: path.read_bytes() for path in before} == before


def test_all_else_must_be_as_it_was(finished, tmp_path):
    run = shutil.copytree(finished / "short", tmp_path / "run")
    data = json.loads((run / "case.json").read_text())
    data["bodies"][0]["material"]["yield_stress"] = 200.0
    (run / "case.json").write_text(json.dumps(data))
    with pytest.raises(CaseError, match=r"yield_stress was 188\.91 and is 200"):
        resume(run, until=0.15)
    assert json.loads((run / "case.json").read_text())["until"] == 0.1


def test_a_checkpoint_of_another_format_is_refused_in_a_sentence(finished, tmp_path):
    """As mpmkit 0.5.0 wrote it."""
    run = shutil.copytree(finished / "short", tmp_path / "run")
    (path,) = Checkpoints(run / "checkpoints").paths()
    path.write_bytes(path.read_bytes().replace(b"checkpoint 2 ", b"checkpoint 1 ", 1))
    with pytest.raises(CaseError, match="was written by another version of mpmkit"):
        resume(run, until=0.15)


def test_a_frame_that_was_deleted_is_listed_no_more(finished, tmp_path):
    run = shutil.copytree(finished / "short", tmp_path / "run")
    gone = sorted((run / "frames").glob("frame_*.vtu"))[2]
    gone.unlink()
    resume(run, until=0.12)
    listed = (run / "frames/frames.pvd").read_text()
    assert gone.name not in listed
    assert all(path.name in listed for path in (run / "frames").glob("frame_*.vtu"))


def test_a_rerun_says_that_the_case_was_edited(finished, tmp_path, capsys):
    run = shutil.copytree(finished / "short", tmp_path / "run")
    data = json.loads((run / "case.json").read_text())
    data["bodies"][0]["material"]["yield_stress"] = 200.0
    (run / "case.json").write_text(json.dumps(data))
    with pytest.raises(SystemExit) as stop:
        main(["rerun", str(run), "--quiet"])
    assert stop.value.code == 1
    said = capsys.readouterr().out.splitlines()
    assert said[0] == (
        "changed since the run: case.json was edited after the run: "
        "bodies.0.material.yield_stress was 188.91 and is 200.0"
    )
    assert said[1].startswith("not the same: ")
