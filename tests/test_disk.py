"""Full or read-only disks, and files that vanish: status 4, one sentence, and no half-written files."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray

from mpmkit.output import read_frame, read_frames
from mpmkit.output.checkpoints import Checkpoints, Damaged, read

CASE = Path(__file__).parents[1] / "cases/slump_fast.json"
RUN = [sys.executable, "-m", "mpmkit", "run", str(CASE), "--quiet"]
PICTURES_OFF = ["--set", "output.report=false"]

IN_A_NAMESPACE = ["unshare", "--map-root-user", "--mount", "sh", "-c"]


def may_mount() -> bool:
    if shutil.which("unshare") is None:
        return False
    tried = subprocess.run([*IN_A_NAMESPACE, "mount -t tmpfs none /tmp"], capture_output=True, check=False)
    return tried.returncode == 0


mounting = pytest.mark.skipif(not may_mount(), reason="needs the right to mount a file system of its own")


def on_a_disk(place: Path, options: str, *arguments: str) -> subprocess.CompletedProcess:
    """Run on a file system mounted at ``place``, and copy what is on it to ``place``-copy before it goes."""
    place.mkdir()
    script = (
        f'mount -t tmpfs -o {options} none "{place}"; "$@"; s=$?; cp -r "{place}" "{place}-copy"; exit $s'
    )
    return subprocess.run(
        [*IN_A_NAMESPACE, script, "sh", *RUN, *arguments, "--out", str(place / "run")],
        capture_output=True,
        text=True,
        check=False,
        timeout=200,
    )


def one_sentence(done: subprocess.CompletedProcess) -> str:
    assert done.returncode == 4, done.stderr
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith("mpmkit: cannot write '"), done.stderr
    assert "Traceback" not in done.stderr
    return last


def assert_readable(directory: Path):
    """Every file with a final name is complete."""
    if (directory / "history.nc").exists():
        with xarray.open_dataset(directory / "history.nc") as history:
            history.load()
            assert history.sizes["time"] >= 1
    for _, frame in read_frames(directory / "frames"):
        assert len(read_frame(frame)["position"]) > 0
    for path in Checkpoints(directory / "checkpoints").paths():
        read(path)
    for path in directory.glob("*.json"):
        json.loads(path.read_text())


@mounting
@pytest.mark.parametrize("size", ["120k", pytest.param("400k", marks=pytest.mark.slow)])
def test_a_disk_that_fills_up(tmp_path, size):
    """A few files of a run fit, and no more; where none fits is tested below, file by file."""
    place = tmp_path / "disk"
    said = one_sentence(
        on_a_disk(place, f"size={size}", *PICTURES_OFF, "--checkpoint-every", "0.1s", "--set",
                  'output.particle_history=["velocity","stress"]')
    )  # fmt: skip
    assert "No space left on device" in said
    assert_readable(tmp_path / "disk-copy" / "run")


@mounting
def test_a_disk_that_cannot_be_written(tmp_path):
    said = one_sentence(on_a_disk(tmp_path / "disk", "ro", *PICTURES_OFF))
    assert "Read-only file system" in said
    assert list((tmp_path / "disk-copy").iterdir()) == []


def limited(size: int):
    """A quota: no file may grow beyond ``size`` bytes."""
    import resource

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


@pytest.mark.skipif(sys.platform == "win32", reason="a limit of POSIX")
@pytest.mark.parametrize("size", [3_000, 60_000])
def test_a_quota(tmp_path, size):
    """Too little for a frame, and for a checkpoint; for the history, see below."""
    done = subprocess.run(
        [*RUN, *PICTURES_OFF, "--until", "1", "--out", "run", "--checkpoint-every", "0.1s"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=limited(size),
    )
    assert one_sentence(done).endswith("File too large")
    assert_readable(tmp_path / "run")


@pytest.mark.skipif(sys.platform == "win32", reason="a limit of POSIX")
def test_a_history_beyond_a_quota(tmp_path):
    """The frames fit: it is the NetCDF library that meets the limit, and calls it an HDF error."""
    script = (
        "import xarray; from pathlib import Path; from mpmkit.output.netcdf import write_dataset; "
        "write_dataset(xarray.Dataset({'a': ('x', [1.0] * 100_000)}), Path('history.nc'))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=limited(100_000),
    )
    assert done.stderr.splitlines()[-1] == (
        "mpmkit.errors.OutputError: cannot write 'history.nc': File too large"
    )
    assert list(tmp_path.iterdir()) == []


@mounting
@pytest.mark.parametrize(
    "writes",
    [
        "FrameWriter(place, SPACE).write(0.0, 0, {}, np.zeros((10_000, 2)))",
        "write_dataset(DATASET, place / 'results.nc')",
    ],
    ids=["a frame", "the results of a study"],
)
def test_each_file_on_a_full_disk_says_so(tmp_path, writes):
    place = tmp_path / "disk"
    place.mkdir()
    script = (
        "import sys; import numpy as np; import xarray; from pathlib import Path; "
        "from mpmkit.output import FrameWriter; from mpmkit.output.netcdf import write_dataset; "
        "from mpmkit.spaces import SPACES; SPACE = SPACES['plane-strain']; "
        f"DATASET = xarray.Dataset({{'a': ('x', [1.0] * 100_000)}}); place = Path(sys.argv[1]); {writes}"
    )
    done = subprocess.run(
        [*IN_A_NAMESPACE, f'mount -t tmpfs -o size=40k none "{place}"; exec "$@"', "sh", sys.executable, "-c",
         script, str(place)],
        capture_output=True,
        text=True,
        check=False,
    )  # fmt: skip
    last = done.stderr.splitlines()[-1]
    assert last.startswith("mpmkit.errors.OutputError: cannot write '")
    assert last.endswith(": No space left on device")


def test_a_run_directory_that_vanishes(tmp_path):
    """Another program deletes files while it runs."""
    process = subprocess.Popen(
        [*RUN, "--out", "run", "--until", "1000"], cwd=tmp_path, stderr=subprocess.PIPE, text=True
    )
    try:
        deadline = time.monotonic() + 60
        while not (tmp_path / "run/history.nc").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        shutil.rmtree(tmp_path / "run")
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 4, said
    assert said.splitlines()[-1].startswith("mpmkit: cannot write '")
    assert "Traceback" not in said


def test_a_case_that_vanished(tmp_path):
    done = subprocess.run([*RUN[:-2], "gone.json"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == 'mpmkit: "gone.json": the case file cannot be read: No such file or directory\n'
    assert list(tmp_path.iterdir()) == []


def test_a_checkpoint_that_vanished(tmp_path):
    with pytest.raises(Damaged, match="No such file"):
        read(tmp_path / "step_000000000001.checkpoint")
