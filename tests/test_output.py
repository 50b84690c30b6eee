"""Files of a run: readable, complete at every moment, and never written over files of a user."""

from __future__ import annotations

import json
import logging
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest
import xarray as xr

from mpmkit.errors import CaseError, OutputError
from mpmkit.output import (
    PARTICLE_VARIABLES,
    FrameWriter,
    History,
    RunDirectory,
    Variable,
    open_log,
    read_frame,
    read_frames,
    summarise,
    write_json,
)
from mpmkit.output import history as history_module
from mpmkit.output.summary import state_at_end
from mpmkit.output.variables import tensor_components
from mpmkit.spaces import SPACES

COLUMNS = [
    Variable("spread_diameter", "m", "spread diameter"),
    Variable("time_step", "s", "time step"),
    Variable("momentum", "kg m/s", "momentum", component=True),
]


def row(spread: float = 0.2) -> dict:
    return {"spread_diameter": spread, "time_step": 1e-5, "momentum": np.array([1.0, -2.0])}


def particle_fields(rng, count: int = 4, dim: int = 2) -> dict:
    shapes = {"position": (count, dim), "velocity": (count, dim), "stress": (count, 6)}
    return {name: rng.normal(size=shapes.get(name, (count,))) for name in PARTICLE_VARIABLES}


def small_history(spreads=(0.2, 0.3, 0.6)) -> History:
    history = History(COLUMNS, {"case": "{}"}, ("x", "z"))
    for index, spread in enumerate(spreads):
        history.record(0.1 * index, row(spread))
    return history


class TestHistory:
    def test_opens_with_xarray_as_it_is_by_default(self, tmp_path):
        rng = np.random.default_rng(1)
        history = History(COLUMNS, {"case": "{}"}, ("x", "z"))
        fields = [particle_fields(rng) for _ in range(3)]
        for index, particles in enumerate(fields):
            history.record(0.1 * index, row(), particles)
        history.write(tmp_path / "history.nc")
        with xr.open_dataset(tmp_path / "history.nc") as read:
            xr.testing.assert_identical(read.load(), history.dataset())
        assert read["time"].dtype == float
        assert read["time"].attrs["units"] == "s"
        assert read["time_step"].dtype == float
        assert read["momentum"].dims == ("time", "component")
        assert list(read["component"].values) == ["x", "z"]
        assert float(read["momentum"].sel(component="z")[0]) == -2.0
        assert read["position"].dims == ("time", "particle", "component")
        assert read["pressure"].dims == ("time", "particle")
        assert read["stress"].dims == ("time", "particle", "tensor_component")
        np.testing.assert_array_equal(read["stress"][1], fields[1]["stress"])
        assert all({"units", "long_name"} <= variable.attrs.keys() for variable in read.variables.values())

    def test_a_row_is_a_copy(self):
        history = History(COLUMNS, {}, ("x", "z"))
        values, fields = row(), {"position": np.zeros((3, 2))}
        history.record(0.0, values, fields)
        values["momentum"][:] = 9.0
        fields["position"][:] = 9.0
        assert history.dataset()["momentum"].values.max() == 1.0
        assert history.dataset()["position"].values.max() == 0.0

    def test_without_rows(self, tmp_path):
        History(COLUMNS, {}, ("x", "z")).write(tmp_path / "history.nc")
        with xr.open_dataset(tmp_path / "history.nc") as read:
            assert dict(read.sizes) == {"time": 0, "component": 2}

    def test_rows_are_alike(self):
        history = small_history()
        with pytest.raises(ValueError, match="a row needs"):
            history.record(1.0, {"spread_diameter": 0.2})
        with pytest.raises(ValueError, match="of the particles"):
            history.record(1.0, row(), {"pressure": np.zeros(3)})

    def test_tensor_components_name_their_axes(self):
        assert tensor_components(("x", "y", "z")) == ["xx", "yy", "zz", "yz", "xz", "xy"]
        assert tensor_components(("x", "z")) == ["xx", "zz", "yy", "yz", "xy", "xz"]
        assert tensor_components(("r", "z")) == ["rr", "zz", "tt", "tz", "rt", "rz"]

    def test_a_write_that_fails_halfway_leaves_the_old_file(self, tmp_path, monkeypatch):
        path = tmp_path / "history.nc"
        history = small_history()
        history.write(path)
        history.record(1.0, row())

        def fill_the_disk(dataset, store):
            store.ds.title = "half a file"
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(xr.Dataset, "dump_to_store", fill_the_disk)
        with pytest.raises(OutputError, match=r"history\.nc.*No space left on device"):
            history.write(path)
        with xr.open_dataset(path) as read:
            assert read.sizes["time"] == 3
        assert [entry.name for entry in tmp_path.iterdir()] == ["history.nc"]

    def test_an_error_of_the_netcdf_library_is_an_output_error(self, tmp_path, monkeypatch):
        def fail(dataset, store):
            raise RuntimeError("NetCDF: HDF error")

        monkeypatch.setattr(xr.Dataset, "dump_to_store", fail)
        with pytest.raises(OutputError, match="HDF error") as caught:
            small_history().write(tmp_path / "history.nc")
        assert caught.value.exit_status == 4

    def test_a_directory_that_is_not_there(self, tmp_path):
        with pytest.raises(OutputError):
            small_history().write(tmp_path / "nowhere" / "history.nc")

    @pytest.mark.parametrize(("duration", "pause"), [(0.01, 5.0), (2.0, 42.0)])
    def test_flushing_is_bounded(self, tmp_path, monkeypatch, duration, pause):
        now, writes = [100.0], []
        history = small_history()

        def write(path):
            writes.append(now[0])
            now[0] += duration

        monkeypatch.setattr(history_module.clock, "monotonic", lambda: now[0])
        monkeypatch.setattr(history, "write", write)
        for after in (0.0, 0.5 * pause, 0.99 * pause, 1.01 * pause):
            now[0] = max(now[0], 100.0 + after)
            history.flush_if_due(tmp_path / "history.nc")
        assert writes == [100.0, 100.0 + 1.01 * pause]


class TestFrames:
    @pytest.mark.parametrize("name", SPACES)
    def test_reads_back_exactly(self, tmp_path, name):
        space, rng = SPACES[name], np.random.default_rng(2)
        writer = FrameWriter(tmp_path / "frames", space)
        position = rng.normal(size=(50, space.dim))
        fields = {
            "velocity": rng.normal(size=(50, space.dim)),
            "half_size": rng.normal(size=(50, 3)),
            "speed": rng.normal(size=50),
            "body": np.arange(50, dtype=np.int32),
            "particle": np.arange(50)[::-1],
        }
        writer.write(1 / 3, 12, fields, position)
        [(time, path)] = read_frames(tmp_path / "frames")
        assert time == 1 / 3
        assert path.name == "frame_000012.vtu"
        frame = read_frame(path)
        axes = list(range(space.dim))
        np.testing.assert_array_equal(frame["position"][:, axes], position)
        np.testing.assert_array_equal(frame["velocity"][:, axes], fields["velocity"])
        if space.dim == 2:
            assert not frame["position"][:, 2].any()  # in the plane that a viewer shows
        for scalar in ("half_size", "speed", "body", "particle"):
            np.testing.assert_array_equal(frame[scalar], fields[scalar])
        assert frame["body"].dtype == np.int32

    def test_the_list_names_every_frame(self, tmp_path):
        writer = FrameWriter(tmp_path, SPACES["plane-strain"])
        for step in range(0, 30, 10):
            writer.write(0.1 * step, step, {}, np.zeros((2, 2)))
            listed = {path for _, path in read_frames(tmp_path)}
            assert listed == set(tmp_path.glob("frame_*.vtu"))
        writer.write(2.0, 20, {}, np.ones((2, 2)))  # the same step again: the end of a run on a frame
        assert [time for time, _ in read_frames(tmp_path)] == [0.0, 1.0, 2.0]
        root = ET.parse(tmp_path / "frames.pvd").getroot()
        assert (root.tag, root.attrib["type"]) == ("VTKFile", "Collection")

    def test_starts_afresh(self, tmp_path):
        FrameWriter(tmp_path, SPACES["3d"]).write(0.0, 0, {}, np.zeros((2, 3)))
        (tmp_path / "view.pvsm").write_text("the user's own")
        FrameWriter(tmp_path, SPACES["3d"])
        assert [path.name for path in tmp_path.iterdir()] == ["view.pvsm"]
        assert read_frames(tmp_path) == []

    def test_a_full_disk(self, tmp_path, monkeypatch):
        import meshio

        writer = FrameWriter(tmp_path, SPACES["3d"])
        writer.write(0.0, 0, {}, np.zeros((2, 3)))

        def fill_the_disk(path, mesh, **options):
            path.write_bytes(b"<VTKFile")
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(meshio, "write", fill_the_disk)
        with pytest.raises(OutputError, match="No space left"):
            writer.write(1.0, 1, {}, np.zeros((2, 3)))
        assert sorted(path.name for path in tmp_path.iterdir()) == ["frame_000000.vtu", "frames.pvd"]
        assert len(read_frames(tmp_path)) == 1

    def test_a_list_that_is_not_one(self, tmp_path):
        (tmp_path / "frames.pvd").write_text("<VTKFile><Collection>")
        with pytest.raises(CaseError, match="not a list of frames"):
            read_frames(tmp_path)


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


class TestSummary:
    def summary(self, history: History, **changes) -> dict:
        given = {"particles": 10, "particle_steps": 200, "steps": 20, "wall_time": 4.0}
        given |= {"stopped_because": "finished", "plugins": {}}
        given |= {"t500": 0.15, "at_rest_since": None, "spread_rate": 0.3}
        return summarise(history.dataset(), **{**given, **changes})

    def test_keys_and_values(self):
        summary = self.summary(small_history())
        keys = "t500 t500_from_lift final_spread final_slump final_height final_spread_rate at_rest_since "
        keys += (
            "simulated_time particles steps wall_time particle_steps_per_second stopped_because ended_by "
            "plugins units"
        )
        assert list(summary) == keys.split()
        assert summary["t500"] == 0.15
        assert summary["at_rest_since"] is None
        assert summary["final_spread"] == 0.6
        assert summary["final_spread_rate"] == 0.3
        assert summary["simulated_time"] == pytest.approx(0.2)
        assert summary["final_height"] is None  # not a column of this history
        assert summary["particle_steps_per_second"] == 50.0

    def test_every_number_has_a_unit(self):
        summary = self.summary(small_history())
        numbers = summary.keys() - {"stopped_because", "ended_by", "plugins", "units"}
        assert summary["units"].keys() == numbers
        assert summary["units"]["t500"] == summary["units"]["at_rest_since"] == "s"
        assert summary["units"]["final_spread"] == "m"

    def test_what_a_guard_refused_is_not_summarised(self):
        """If a particle was thrown out in the last row, there is no final shape and no rest."""
        thrown_out = self.summary(small_history(), stopped_because="particle-outside", at_rest_since=0.1)
        assert thrown_out["at_rest_since"] is thrown_out["final_spread"] is None
        assert thrown_out["final_spread_rate"] is None
        assert thrown_out["simulated_time"] == pytest.approx(0.2)
        assert state_at_end(thrown_out) is None
        assert self.summary(small_history(), stopped_because="interrupted")["final_spread"] == 0.6

    def test_of_a_run_that_never_started(self):
        summary = self.summary(small_history(()), wall_time=0.0, t500=None)
        assert summary["t500"] is summary["final_spread"] is summary["particle_steps_per_second"] is None

    def test_the_state_at_the_end_in_words(self):
        words = {(1.234, 0.0): "at rest since t = 1.23 s", (None, 0.4583): "still spreading, 458 mm/s"}
        words |= {(None, None): "still moving", (None, -0.2): "still moving"}
        for (since, rate), sentence in words.items():
            summary = self.summary(small_history(), at_rest_since=since, spread_rate=rate)
            assert state_at_end(summary) == sentence


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
    import subprocess
    import sys

    code = (
        "import sys, mpmkit.output; print({'xarray', 'meshio', 'matplotlib', 'netCDF4'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


WRITERS = """
import sys, threading
from pathlib import Path
import numpy as np, xarray
from mpmkit.output.netcdf import read_dataset, write_dataset

def work(name):
    for turn in range(30):
        written = xarray.Dataset({f"v{k}": ("time", np.arange(50.0) + turn) for k in range(20)})
        write_dataset(written, Path(sys.argv[1], f"{name}.nc"))
        assert read_dataset(Path(sys.argv[1], f"{name}.nc")).identical(written)
    whole.append(name)

whole = []
threads = [threading.Thread(target=work, args=(name,)) for name in "abcd"]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(*sorted(whole))
"""


def test_netcdf_files_may_be_written_and_read_from_several_threads(tmp_path):
    """The library crashed the whole process: HDF5 is not safe to use from two threads."""
    done = subprocess.run(
        [sys.executable, "-c", WRITERS, str(tmp_path)],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert (done.returncode, done.stdout) == (0, "a b c d\n"), done.stderr
