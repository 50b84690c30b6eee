"""Compiled code is kept between processes until any of its sources changes."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import textwrap
import time

import numba
import pytest

from mpmkit.kernels import code_folders
from mpmkit.kernels.code_cache import cached_code
from mpmkit.kernels.code_folders import FOLDER, IN_USE, KEPT
from mpmkit.kernels.fingerprint import fingerprint

RUN = """
import os
import numpy as np
import plug.code
out = np.empty(3)
plug.code.late()
plug.code.scaled(np.ones(3), out)
stats = plug.code.scaled.stats
print(out[0], sum(stats.cache_hits.values()), sum(stats.cache_misses.values()))
"""
PLUG = {
    "plug/__init__.py": "",
    "plug/viscosity.txt": "50.0",
    "plug/constants.py": "FACTOR = 2.0\n",
    "plug/helper.py": """
        from mpmkit.kernels.compile import inline
        from .constants import FACTOR

        @inline()
        def change(x):
            return FACTOR * x
    """,
    "other/__init__.py": "RATE = 3.0\n",
    "other/inner.py": "WIDTH = 1.0\n",
    "other/rules.py": """
        import numba
        from . import RATE

        @numba.njit
        def rule(x):
            return RATE + x
    """,
    "plug/code.py": """
        import os
        from pathlib import Path

        import numpy as np
        import other.inner
        from other.rules import rule

        from mpmkit.kernels.compile import function
        from .helper import change

        VISCOSITY = float(Path(__file__).with_name("viscosity.txt").read_text())
        TABLE = np.array([0.0, float(os.environ.get("TABLE", "1"))])
        PAIR = (1.0, (int(os.environ.get("PAIR", "0")),))
        LATE = 0.0

        def late():
            global LATE
            LATE = float(os.environ.get("LATE", "0"))

        def power(exponent):
            @function()
            def raised(x):
                return x**exponent
            return raised

        raised = power(int(os.environ.get("EXPONENT", "1")))

        def maker(inner):
            @function()
            def scaled(x, out):
                for i in range(len(x)):
                    whole = rule(change(x[i])) * VISCOSITY * TABLE[1] + PAIR[1][0] + LATE
                    out[i] = inner(whole) * other.inner.WIDTH
            return scaled

        scaled = maker(raised)
    """,
}
CHANGES = {
    "a data file": ({"plug/viscosity.txt": "500.0"}, {}, 2500.0),
    "a constant of another file": ({"plug/constants.py": "FACTOR = 7.0\n"}, {}, 500.0),
    "a function of another file": ({"plug/helper.py": ("FACTOR * x", "FACTOR - x")}, {}, 200.0),
    "a constant of another package": ({"other/__init__.py": "RATE = 8.0\n"}, {}, 500.0),
    "a module of another package": ({"other/inner.py": "WIDTH = 2.0\n"}, {}, 500.0),
    "a function of another package": ({"other/rules.py": ("RATE + x", "RATE * x")}, {}, 300.0),
    "an array from the environment": ({}, {"TABLE": "2"}, 500.0),
    "a tuple from the environment": ({}, {"PAIR": "5"}, 255.0),
    "a constant that is set later": ({}, {"LATE": "4"}, 254.0),
    "what a function closes over": ({}, {"EXPONENT": "2"}, 62500.0),
}


NURSERY = """
import json, os, sys, traceback
import numba
import mpmkit.kernels.compile
numba.njit(lambda x: x)(1.0)
sys.dont_write_bytecode = True  # sources of one length that change within a second
for line in sys.stdin:
    folder, environment, code = json.loads(line)
    if os.fork() == 0:
        try:
            os.chdir(folder)
            os.environ.update(environment)
            sys.path.insert(0, folder)
            exec(code, {})
        except BaseException:
            traceback.print_exc(file=sys.stdout)
        print(flush=True)
        os._exit(0)
    os.wait()
"""


@pytest.fixture(scope="module")
def fresh_run():
    """What a fresh process finds: a result, how often compiled code was found, and how often not.

    The process is forked from one that has loaded numba and its compiler, which saves a second each time.
    The functions have no parallel loops, which take three times as long to compile: the cache is the same.
    """

    def run(folder, more=None):
        environment = {"NUMBA_CACHE_DIR": str(folder / "cache"), **(more or {})}
        print(json.dumps([str(folder), environment, RUN]), file=nursery.stdin, flush=True)
        said = "".join(iter(nursery.stdout.readline, "\n"))
        assert len(said.split()) == 3, said
        return tuple(map(float, said.split()))

    command = [sys.executable, "-c", NURSERY]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as nursery:
        yield run
        nursery.stdin.close()


def write_sources(folder, files):
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(textwrap.dedent(text))


@pytest.fixture(scope="module")
def compiled_once(tmp_path_factory, fresh_run):
    """A package whose kernel takes constants from everywhere, and its code, just compiled."""
    folder = tmp_path_factory.mktemp("compiled")
    write_sources(folder, PLUG)
    assert fresh_run(folder) == (250.0, 0, 1)
    assert fresh_run(folder) == (250.0, 1, 0)
    return folder


@pytest.mark.parametrize("change", CHANGES)
def test_whatever_changes_that_a_kernel_is_compiled_with_compiles_it_anew(change, compiled_once, fresh_run):
    """The new value is used, from every source; when the old value is restored, the old code is found
    again."""
    files, environment, expected = CHANGES[change]
    before = {name: (compiled_once / name).read_text() for name in files}
    for name, new in files.items():
        (compiled_once / name).write_text(before[name].replace(*new) if isinstance(new, tuple) else new)
    try:
        assert fresh_run(compiled_once, environment) == (expected, 0, 1)
    finally:
        for name, text in before.items():
            (compiled_once / name).write_text(text)


def test_another_copy_of_the_same_sources_finds_the_same_code(compiled_once, fresh_run, tmp_path):
    copy = shutil.copytree(compiled_once, tmp_path / "copy")
    assert fresh_run(copy) == (250.0, 1, 0)


@pytest.mark.parametrize(
    "called", ["numba.njit(cache=True)", "numba.extending.register_jitable", "numba.vectorize"]
)
def test_a_kernel_that_calls_what_has_no_key_is_not_kept(called, tmp_path, fresh_run):
    """The code of a plain Python function may change without notice, because numba's own cache only checks
    the file."""
    source = f"""
        import numba
        from mpmkit.kernels.compile import function

        def late():
            pass

        @{called}
        def other(x):
            return 5.0 * x

        @function()
        def scaled(x, out):
            for i in range(len(x)):
                out[i] = other(x[i])
    """
    write_sources(tmp_path, {"plug/__init__.py": "", "plug/code.py": source})
    assert [fresh_run(tmp_path), fresh_run(tmp_path)] == [(5.0, 0, 1)] * 2


FACTOR = 2.0


def changing(x):
    return FACTOR * x


def test_a_constant_that_changes_within_a_process_is_not_kept_as_another(monkeypatch, tmp_path):
    """numba keeps the old constant in a function that it has compiled; our cache must not keep that code."""
    monkeypatch.setattr(code_folders, "cache_root", lambda: tmp_path)
    inner = cached_code(numba.njit)(changing)
    assert inner(1.0) == 2.0
    monkeypatch.setitem(globals(), "FACTOR", 3.0)
    outer = cached_code(numba.njit)(lambda x: inner(x) + 1)
    assert outer(1.0) == 3.0
    assert len(list(tmp_path.rglob("*.code"))) == 1
    assert cached_code(numba.njit)(changing)(1.0) == 3.0


def next_to_nothing(x):
    """0 for any small x where sums are rounded one by one; x where the compiler may reorder them."""
    return (x + 1e16) - 1e16


def test_code_of_other_compile_flags_is_another(monkeypatch, tmp_path):
    """With ``fastmath`` the bits differ, so code with it and code without it must not be confused."""
    monkeypatch.setattr(code_folders, "cache_root", lambda: tmp_path)
    found = {}
    for time_ in ("compiled", "kept"):
        for fastmath in (False, True, {"contract"}):
            function = cached_code(numba.njit, fastmath=fastmath)(next_to_nothing)
            found[time_, str(fastmath)] = function(0.3)
            assert bool(function.stats.cache_hits) == (time_ == "kept")
    assert found["compiled", "False"] == found["compiled", "{'contract'}"] == 0.0
    assert found["compiled", "True"] == 0.3
    assert all(found["kept", fastmath] == value for (_, fastmath), value in found.items())


@pytest.mark.parametrize(
    "flags",
    [
        {"fastmath": True},
        {"error_model": "numpy"},
        {"parallel": True},
        {"boundscheck": True},
        {"nogil": True},
    ],
    ids=lambda flags: next(iter(flags)),
)
def test_every_compile_flag_is_in_the_fingerprint(flags):
    plain, other = (cached_code(numba.njit, **chosen)(next_to_nothing) for chosen in ({}, flags))
    assert fingerprint(other) != fingerprint(plain)
    assert fingerprint(cached_code(numba.njit, **flags)(next_to_nothing)) == fingerprint(other)


def test_nothing_of_the_users_in_the_folder_of_compiled_code_is_touched(tmp_path, fresh_run):
    """Such a folder of a user, named like ours, was once deleted with the results in it."""
    old = time.time() - 30 * IN_USE
    for i in range(2 * KEPT):
        for folder in (f"mpmkit-results{i}", "mpmkit-results", f"plug-{i:016x}"):
            (tmp_path / "cache" / folder).mkdir(parents=True, exist_ok=True)
            (tmp_path / "cache" / folder / f"thesis{i}.code").write_text("three years of work")
            os.utime(tmp_path / "cache" / folder, (old, old))
    before = sorted((tmp_path / "cache").rglob("*"))
    write_sources(tmp_path, PLUG)
    assert fresh_run(tmp_path) == (250.0, 0, 1)
    assert [path for path in before if not path.exists()] == []
    assert {path.name for path in (tmp_path / "cache").iterdir()} - {path.name for path in before} == {FOLDER}
