"""The run directory and its log: files of a user are never overwritten."""

from __future__ import annotations

import json
import logging
import shutil
import subprocess
import sys

import numpy as np
import pytest

from mpmkit.errors import CaseError, OutputError
from mpmkit.output import RunDirectory, open_log, write_json


class TestRunDirectory:
    @staticmethod
    def fill(run: RunDirectory) -> None:
        run.claim()
        for path in (run.case, run.history, run.summary, run.log):
            path.write_text("old")
        for path in (run.frames / "frame_000010.vtu", run.frames / "frames.pvd", run.report / "outline.png"):
            path.parent.mkdir(exist_ok=True)
            path.write_text("old")

    def test_is_made(self, tmp_path):
        run = RunDirectory(tmp_path / "runs" / "slump")
        run.claim()
        assert run.path.is_dir()
        run.claim()  # empty still

    def test_is_not_overwritten_unless_asked(self, tmp_path):
        self.fill(RunDirectory(tmp_path / "run"))
        with pytest.raises(CaseError, match=r"--overwrite.*--out") as caught:
            RunDirectory(tmp_path / "run").claim()
        assert caught.value.exit_status == 2
        assert (tmp_path / "run" / "case.json").read_text() == "old"

    def test_overwriting_deletes_what_a_run_writes_and_nothing_else(self, tmp_path):
        self.fill(RunDirectory(tmp_path / "run"))
        own = ["notes.txt", "frames/mine.vtu", "frames/frame_of_mine.vtu", "report/for_the_thesis.png"]
        own += ["checkpoints/step_by_step.checkpoint"]
        (tmp_path / "run" / "checkpoints").mkdir()
        for name in own:
            (tmp_path / "run" / name).write_text("the user's own")
        (tmp_path / "run" / ".history.nc.partial").write_text("left by a killed process")
        RunDirectory(tmp_path / "run", overwrite=True).claim()
        left = [path for path in (tmp_path / "run").rglob("*") if path.is_file()]
        assert sorted(left) == sorted(tmp_path / "run" / name for name in own)

    def test_overwriting_does_not_follow_links(self, tmp_path):
        self.fill(RunDirectory(tmp_path / "run"))
        (tmp_path / "kept").mkdir()
        (tmp_path / "kept" / "frame_000010.vtu").write_text("")
        shutil.rmtree(tmp_path / "run" / "frames")
        (tmp_path / "run" / "frames").symlink_to(tmp_path / "kept")
        RunDirectory(tmp_path / "run", overwrite=True).claim()
        assert (tmp_path / "kept" / "frame_000010.vtu").exists()

    @pytest.mark.parametrize("name", ["thesis.tex", "case.json", "run.log"])
    def test_what_does_not_look_like_a_run_is_left_alone(self, tmp_path, name):
        (tmp_path / name).write_text("the user's own")
        with pytest.raises(CaseError, match="does not look like"):
            RunDirectory(tmp_path, overwrite=True).claim()
        assert (tmp_path / name).exists()

    def test_a_file_in_its_place(self, tmp_path):
        (tmp_path / "run").write_text("")
        with pytest.raises(OutputError) as caught:
            RunDirectory(tmp_path / "run").claim()
        assert caught.value.exit_status == 4

    def test_json(self, tmp_path):
        run = RunDirectory(tmp_path)
        data = {
            "t500": float("nan"),
            "steps": np.int64(3),
            "list": [np.float64(1.5), np.inf],
            "a": np.arange(2),
        }
        write_json(run.summary, data)
        text = run.summary.read_text()
        assert json.loads(text) == {"t500": None, "steps": 3, "list": [1.5, None], "a": [0, 1]}
        assert text.startswith('{\n  "t500"')
        with pytest.raises(TypeError):
            write_json(run.summary, {"bad": object()})
        assert run.summary.read_text() == text
        with pytest.raises(OutputError):
            write_json(tmp_path / "nowhere" / "summary.json", {})


class TestLog:
    def test_is_written_until_it_is_closed(self, tmp_path):
        logger = logging.getLogger("mpmkit")
        level = logger.level
        with open_log(tmp_path / "run.log") as log:
            logging.getLogger("mpmkit.solver").info("step %d", 3)
        logger.warning("too late")
        log.close()
        [line] = (tmp_path / "run.log").read_text().splitlines()
        assert line.endswith("INFO    step 3")
        assert line[:2] == "20"
        assert log not in logger.handlers
        assert logger.level == level

    def test_that_cannot_be_opened(self, tmp_path):
        with pytest.raises(OutputError):
            open_log(tmp_path / "nowhere" / "run.log")


def test_importing_the_package_loads_none_of_the_heavy_libraries():
    code = (
        "import sys, mpmkit.output; print({'xarray', 'meshio', 'matplotlib', 'netCDF4'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
