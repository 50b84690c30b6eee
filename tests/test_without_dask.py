"""A run does not load Dask, wherever it is installed; a dataset can still be made of its arrays elsewhere."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
WRITE = """
import sys
from pathlib import Path
from mpmkit.output.netcdf import leave_dask_out, read_dataset, write_dataset
leave_dask_out()
import numpy as np, xarray
along = {"wall": ["a", "bb"], "time": [0.0, 1.0]}
force = xarray.DataArray(np.ones((2, 2)), dims=("time", "wall"), coords=along, attrs={"units": "N"})
made = xarray.Dataset({"force": force}, attrs={"name": "x"})
write_dataset(made, Path("made.nc"))
found = read_dataset(Path("made.nc"))
assert found.identical(made), (found, made)
assert "dask" not in sys.modules
"""


@pytest.fixture
def with_a_dask(tmp_path):
    """Where there is a Dask that ends the process which loads it."""
    (tmp_path / "dask").mkdir()
    (tmp_path / "dask" / "__init__.py").write_text(
        "import os\nos.write(2, b'Dask was loaded')\nos._exit(9)\n"
    )
    return {"cwd": tmp_path, "env": os.environ | {"PYTHONPATH": str(tmp_path)}, "capture_output": True}


def test_a_history_is_written_and_read_without_dask(with_a_dask):
    done = subprocess.run([sys.executable, "-c", WRITE], **with_a_dask)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_a_whole_run_is_without_dask(with_a_dask):
    case = ROOT / "cases" / "slump_fast.json"
    command = [sys.executable, "-m", "mpmkit", "run", str(case), "--until", "0.02", "--out", "run"]
    done = subprocess.run(command, **with_a_dask)
    assert done.returncode == 0, done.stderr
