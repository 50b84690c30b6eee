"""``mpmkit doctor``: facts for a bug report, and a sentence for each problem."""

import json
import os
import platform
import re
import shutil
import subprocess
import sys
from collections import namedtuple
from importlib.metadata import version

import numba
import numpy
import psutil
import pytest

import mpmkit
from mpmkit.cli import main
from mpmkit.doctor import SECTIONS, Finding, examine, machine, versions
from mpmkit.registry import Problem, Registry


def doctor(capsys, *arguments):
    with pytest.raises(SystemExit) as ended:
        main(["doctor", *arguments])
    assert ended.value.code == 0
    return capsys.readouterr().out


def test_the_facts_are_those_of_this_process(capsys):
    found = json.loads(doctor(capsys, "--json"))
    assert found.keys() == {*SECTIONS, "problems"}
    assert found["versions"]["mpmkit"] == mpmkit.__version__
    assert found["versions"]["numpy"] == numpy.__version__ == version("numpy")
    assert found["versions"]["Python"].startswith(platform.python_version())
    assert found["threads"]["most threads"] == numba.config.NUMBA_NUM_THREADS
    assert found["machine"]["cores"].endswith(f"{len(os.sched_getaffinity(0))} for this process")
    total = int(found["memory"]["of the machine"].removesuffix(" MiB").replace(",", ""))
    assert total == pytest.approx(psutil.virtual_memory().total / 2**20, abs=1)


def test_the_text_has_every_fact_and_ends_with_the_problems(capsys):
    text, facts = doctor(capsys), json.loads(doctor(capsys, "--json"))
    for name in SECTIONS:
        assert f"{name}\n" in text
        assert all(key in text for key in facts[name])
    assert text.splitlines()[-1].startswith("  ")
    assert "\nproblems\n" in text
    assert re.search(rf"^  llvmlite +{re.escape(facts['versions']['llvmlite'])}$", text, re.MULTILINE)


def test_the_width_of_the_vectors_is_that_of_the_widest_feature(monkeypatch):
    import llvmlite.binding as llvm

    for features, said in [
        ({"sse2": True, "avx2": True, "avx512f": False}, "256 bits, 4 doubles"),
        ({"sse2": True}, "128 bits, 2 doubles"),
        ({}, "not known"),
    ]:
        monkeypatch.setattr(llvm, "get_host_cpu_features", lambda features=features: features)
        assert machine.machine().facts["vector width"] == said


def test_compiled_kernels_are_counted(tmp_path, monkeypatch):
    from mpmkit.doctor.caches import caches
    from mpmkit.kernels import code_folders

    folder = tmp_path / "package-0"
    folder.mkdir()
    (folder / "a.code").write_bytes(bytes(3 * 2**20))
    (folder / "b.code").write_bytes(bytes(2**20))
    monkeypatch.setattr(code_folders, "cache_root", lambda: tmp_path)
    assert caches().facts == {"compiled kernels": f"{tmp_path}, 4 MiB in 2 files"}
    monkeypatch.setattr(code_folders, "cache_root", lambda: None)
    assert "set NUMBA_CACHE_DIR to a folder that can be written" in caches().problems[0]


def test_each_problem_is_a_sentence(monkeypatch, capsys):
    monkeypatch.setenv("NUMBA_BOUNDSCHECK", "1")
    monkeypatch.setattr(versions, "_used", lambda: [("numpy", False), ("no-such-package", False)])
    monkeypatch.setattr(shutil, "disk_usage", lambda _: namedtuple("Usage", "free")(5 * 2**20))
    monkeypatch.setattr("mpmkit.solver.available_memory.tightest_limit", lambda: (2**20, "by ulimit -v"))
    broken = Registry([], [Problem("honey", "law.honey", "its module does not load", "law", "honey")])
    monkeypatch.setattr("mpmkit.registry.installed", lambda: broken)
    text = doctor(capsys)
    for sentence in (
        "the package 'no-such-package', which mpmkit needs, is not installed",
        "NUMBA_BOUNDSCHECK is '1': kernels check every index and runs are several times slower; unset it",
        "only 5 MiB are free on the disk of",
        "only 1 MiB of memory are left by ulimit -v",
        "plug-in 'law.honey' of distribution 'honey' is not usable: its module does not load",
    ):
        assert sentence in text.partition("\nproblems\n")[2]


def test_a_section_that_fails_leaves_the_others_alone(monkeypatch):
    def fail() -> Finding:
        raise OSError("no such device")

    monkeypatch.setitem(SECTIONS, "disk", fail)
    found = examine()
    assert found["disk"].problems == ["the section 'disk' could not be examined: OSError: no such device"]
    assert found["versions"].facts["mpmkit"] == mpmkit.__version__


@pytest.mark.parametrize(("name", "value"), [("NUMBA_NUM_THREADS", "abc"), ("NUMBA_THREADING_LAYER", "foo")])
def test_an_environment_in_which_nothing_runs_is_described_all_the_same(name, value):
    command = [sys.executable, "-m", "mpmkit", "doctor"]
    environment = os.environ | {name: value}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert f"the environment variable {name} is '{value}'" in done.stdout.partition("\nproblems\n")[2]
    assert "Traceback" not in done.stdout + done.stderr
    assert "working directory" in done.stdout
