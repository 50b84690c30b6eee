"""The history of a run: its file, which is complete at every moment."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from histories import COLUMNS, particle_fields, row, small_history

from mpmkit.errors import OutputError
from mpmkit.output import History
from mpmkit.output import history as history_module
from mpmkit.output.variables import tensor_components


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
