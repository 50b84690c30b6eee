"""Disks that are full or read-only, files that vanish: status 4, one sentence, nothing half-written left."""

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
    """Every file that has its name is whole; nothing half-written is left with one."""
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
@pytest.mark.parametrize("size", ["40k", "120k", "400k"])
def test_a_disk_that_fills_up(tmp_path, size):
    """A few files of a run fit, and no more."""
    place = tmp_path / "disk"
    said = one_sentence(
        on_a_disk(place, f"size={size}", *PICTURES_OFF, "--checkpoint-every", "0.1s", "--set",
                  'output.particle_history=["velocity","stress"]')
    )  # fmt: skip
    assert "No space left on device" in said or "HDF error" in said
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
@pytest.mark.parametrize("size", [3_000, 30_000, 60_000])
def test_a_quota(tmp_path, size):
    """Too little for a frame, for the history, for a checkpoint."""
    done = subprocess.run(
        [*RUN, *PICTURES_OFF, "--until", "1", "--out", "run", "--checkpoint-every", "0.1s"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=limited(size),
    )
    one_sentence(done)
    assert_readable(tmp_path / "run")


def test_a_run_directory_that_vanishes(tmp_path):
    """Somebody tidies up while it runs."""
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
