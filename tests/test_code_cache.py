"""Compiled code outlives the process for as long as no source changes, whichever it is, and no longer."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import numba
import numpy as np
import pytest

from mpmkit.kernels import code_cache
from mpmkit.kernels.code_cache import IN_USE, KEPT, cached_code, digest, forget_old_generations


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "inner").mkdir()
    for name in ("a.py", "b.py", "inner/c.py"):
        (tmp_path / name).write_text(f"NAME = {name!r}\n")
    (tmp_path / "notes.txt").write_text("nothing that is compiled\n")
    return tmp_path


@pytest.mark.parametrize("name", ["a.py", "b.py", "inner/c.py"])
def test_the_digest_changes_with_every_source(folder, name):
    before = digest((folder,))
    text = (folder / name).read_text()
    (folder / name).write_text(text + "FACTOR = 2.0\n")
    assert digest((folder,)) != before
    (folder / name).write_text(text)
    assert digest((folder,)) == before


def test_the_digest_changes_with_files_that_come_go_or_are_renamed(folder):
    found = {digest((folder,))}
    (folder / "d.py").write_text("")
    found.add(digest((folder,)))
    (folder / "d.py").rename(folder / "e.py")
    found.add(digest((folder,)))
    (folder / "a.py").unlink()
    found.add(digest((folder,)))
    assert len(found) == 4


def test_the_digest_is_of_sources_and_versions_alone(folder):
    before = digest((folder,), ("3.11", "0.60"))
    (folder / "notes.txt").write_text("something else\n")
    os.utime(folder / "a.py", (1, 1))
    assert digest((folder,), ("3.11", "0.60")) == before
    assert digest((folder,), ("3.11", "0.61")) != before
    assert digest((folder / "a.py",)) != digest((folder / "b.py",))


def generations(root, ages, name="plug"):
    """Folders of compiled code last used so many seconds ago."""
    for i, age in enumerate(ages):
        path = root / f"{name}-{i:016x}"
        path.mkdir()
        (path / "kernel.nbi").write_bytes(b"code")
        os.utime(path, (time.time() - age,) * 2)


def left(root):
    return {path.name for path in root.iterdir()}


def test_old_generations_are_forgotten_but_for_the_last_few(tmp_path):
    generations(tmp_path, [IN_USE + 60 * i for i in reversed(range(1, KEPT + 4))])
    forget_old_generations(tmp_path, "plug")
    assert left(tmp_path) == {f"plug-{i:016x}" for i in range(3, KEPT + 3)}


def test_generations_that_a_run_may_be_using_are_kept(tmp_path):
    generations(tmp_path, [60 * i for i in range(KEPT + 3)] + [IN_USE + 60, IN_USE - 60])
    forget_old_generations(tmp_path, "plug")
    assert left(tmp_path) == {f"plug-{i:016x}" for i in range(KEPT + 5) if i != KEPT + 3}


def test_generations_of_other_packages_are_left_alone(tmp_path):
    for name in ("plug", "plug-in", "plugs"):
        generations(tmp_path, [2 * IN_USE] * (KEPT + 2), name)
    forget_old_generations(tmp_path, "plug")
    names = Counter(name.rpartition("-")[0] for name in left(tmp_path))
    assert names == {"plug": KEPT, "plug-in": KEPT + 2, "plugs": KEPT + 2}


def test_a_place_that_cannot_be_written_is_no_place(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file"))
    assert code_cache.cache_root.__wrapped__() is None
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "new" / "folder"))
    assert code_cache.cache_root.__wrapped__() == tmp_path / "new" / "folder"


def twice(x):
    return 2 * x


def test_without_a_place_code_is_compiled_and_not_kept(monkeypatch):
    monkeypatch.setattr(code_cache, "cache_root", lambda: None)
    compiled = cached_code(numba.njit)(twice)
    assert compiled(21) == 42
    assert compiled.stats.cache_path is None


def test_the_place_of_other_code_is_left_as_it_was(monkeypatch, tmp_path):
    before = numba.config.CACHE_DIR
    monkeypatch.setattr(code_cache, "cache_root", lambda: tmp_path)
    compiled = cached_code(numba.njit)(twice)
    assert before == numba.config.CACHE_DIR
    assert tmp_path in Path(compiled.stats.cache_path).parents


CONSTANTS = "FACTOR = {}\n"
HELPER = """
from mpmkit.kernels.compile import inline

@inline()
def change(x, factor):
    return {}
"""
CODE = """
from numba import prange
from mpmkit.kernels.compile import kernel
from .constants import FACTOR
from .helper import change

@kernel()
def scaled(x, out):
    for i in prange(len(x)):
        out[i] = change(x[i], FACTOR)
"""
RUN = """
import numpy as np
from plug.code import scaled
out = np.empty(3)
scaled(np.ones(3), out)
print(*out, sum(scaled.stats.cache_hits.values()), sum(scaled.stats.cache_misses.values()))
"""


def run(folder):
    """What a fresh process finds: the results, how often compiled code was found, and how often not."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "cache")}
    environment["PYTHONPATH"] = os.pathsep.join([str(folder), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment["PYTHONDONTWRITEBYTECODE"] = "1"  # sources of one length that change within a second
    done = subprocess.run(
        [sys.executable, "-c", RUN], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    *values, hits, misses = np.array(done.stdout.split(), dtype=float)
    return values, hits, misses


def test_a_change_anywhere_in_a_package_compiles_its_kernels_anew(tmp_path):
    """A constant and a function of other files, compiled into a kernel; unchanged, nothing is compiled."""
    package = tmp_path / "plug"
    package.mkdir()
    for name, text in (("__init__", ""), ("code", CODE), ("helper", HELPER.format("factor * x"))):
        (package / f"{name}.py").write_text(text)
    (package / "constants.py").write_text(CONSTANTS.format(2.0))
    assert run(tmp_path) == ([2.0] * 3, 0, 1)
    (package / "constants.py").write_text(CONSTANTS.format(3.0))
    assert run(tmp_path) == ([3.0] * 3, 0, 1)
    assert run(tmp_path) == ([3.0] * 3, 1, 0)
    (package / "helper.py").write_text(HELPER.format("factor + x"))
    assert run(tmp_path) == ([4.0] * 3, 0, 1)
    assert sum(path.name.startswith("plug-") for path in (tmp_path / "cache").iterdir()) == 3


STEPS = """
import hashlib, sys
import mpmkit
case, *changes = sys.argv[1:]
simulation = mpmkit.Simulation(mpmkit.load_case(case, changes))
while simulation.steps < 20:
    simulation.advance()
particles = simulation.particles
print(*(hashlib.sha256(getattr(particles, name).tobytes()).hexdigest()
        for name in ("position", "velocity", "affine", "stress", "volume_ratio")))
"""
COARSE = ["grid.cell_size=0.02", 'grid.domain={"x": [0, 0.36], "y": [0, 0.36], "z": [0, 0.32]}']
REGULARISED = [
    "bodies.0.material.law=herschel-bulkley",
    "bodies.0.material.regularisation=100",
    "scheme.velocity=flip",
    "scheme.order=usf",
]


@pytest.mark.parametrize(
    "arguments",
    [
        ["slump_fast"],
        pytest.param(["slump_quarter", *COARSE], marks=pytest.mark.slow),
        pytest.param(["slump_quarter", *COARSE, *REGULARISED], marks=pytest.mark.slow),
    ],
    ids=["axisymmetric", "3-D", "3-D, regularised"],
)
def test_code_just_compiled_and_code_that_was_kept_agree_to_the_bit(arguments, tmp_path):
    """The compiler goes over kept code once more: nothing may be left to its freedom to round otherwise."""
    name, *changes = arguments
    case = Path(__file__).parents[1] / "cases" / f"{name}.json"
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_NUM_THREADS": "1"}
    command = [sys.executable, "-c", STEPS, str(case), *changes]
    found = [subprocess.check_output(command, env=environment, text=True) for _ in range(2)]
    assert found[0] == found[1]
