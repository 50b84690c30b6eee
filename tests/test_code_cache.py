"""Compiled code outlives the process for as long as no source changes, whichever it is, and no longer."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import textwrap
import time
from collections import Counter
from pathlib import Path

import numba
import pytest

from mpmkit.kernels import code_folders
from mpmkit.kernels.code_cache import cached_code, digest
from mpmkit.kernels.code_folders import FOLDER, IN_USE, KEPT, MARKER, TAG, VERSIONS, forget_generations, write
from mpmkit.kernels.fingerprint import fingerprint


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


def generations(root, ages, name="plug", marker=TAG):
    """Folders of compiled code last used so many seconds ago."""
    for i, age in enumerate(ages):
        path = root / f"{name}-{i:016x}"
        path.mkdir()
        (path / "kernel.key.code").write_bytes(b"code")
        if marker is not None:
            (path / MARKER).write_text(marker)
        os.utime(path, (time.time() - age,) * 2)


def left(root):
    return {path.name for path in root.iterdir()}


def test_old_generations_are_forgotten_but_for_the_last_few(tmp_path):
    generations(tmp_path, [IN_USE + 60 * i for i in reversed(range(1, KEPT + 4))])
    forget_generations(tmp_path, "plug")
    assert left(tmp_path) == {f"plug-{i:016x}" for i in range(3, KEPT + 3)}


def test_generations_that_a_run_may_be_using_are_kept(tmp_path):
    generations(tmp_path, [60 * i for i in range(KEPT + 3)] + [IN_USE + 60, IN_USE - 60])
    forget_generations(tmp_path, "plug")
    assert left(tmp_path) == {f"plug-{i:016x}" for i in range(KEPT + 5) if i != KEPT + 3}


def test_generations_of_other_packages_are_left_alone(tmp_path):
    for name in ("plug", "plug-in", "plugs"):
        generations(tmp_path, [2 * IN_USE] * (KEPT + 2), name)
    forget_generations(tmp_path, "plug")
    names = Counter(name.rpartition("-")[0] for name in left(tmp_path))
    assert names == {"plug": KEPT, "plug-in": KEPT + 2, "plugs": KEPT + 2}


@pytest.mark.parametrize("marker", [None, TAG.replace("mpmkit", "another program")])
def test_a_folder_without_our_marker_is_left_alone(tmp_path, marker):
    generations(tmp_path, [2 * IN_USE] * (KEPT + 3), marker=marker)
    forget_generations(tmp_path, "plug")
    assert len(left(tmp_path)) == KEPT + 3


def test_what_a_user_put_into_an_old_generation_stays(tmp_path):
    generations(tmp_path, [2 * IN_USE] * KEPT + [3 * IN_USE])
    old = tmp_path / f"plug-{KEPT:016x}"
    (old / "notes.txt").write_text("of the user's")
    os.utime(old, (time.time() - 3 * IN_USE,) * 2)
    forget_generations(tmp_path, "plug")
    assert left(old) == {"notes.txt", MARKER}


def test_what_is_compiled_for_ever_new_constants_is_forgotten(tmp_path):
    """A constant that is another one in every process must not fill the disk."""
    generation = tmp_path / "plug-0123456789abcdef"
    write(generation / "other.key.code", b"code")
    write(generation / ".kernel.77.code.partial", b"of a process that was killed")
    for i in range(VERSIONS + 5):
        write(generation / f"kernel.{i}.code", b"code")
        os.utime(generation / f"kernel.{i}.code", (time.time() - 2 * IN_USE + i,) * 2)
    os.utime(generation / ".kernel.77.code.partial", (time.time() - 2 * IN_USE,) * 2)
    write(generation / "kernel.last.code", b"code")
    kept = {f"kernel.{i}.code" for i in range(6, VERSIONS + 5)}
    assert left(generation) == {MARKER, "other.key.code", "kernel.last.code"} | kept


def test_a_place_that_cannot_be_written_is_no_place(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file"))
    assert code_folders.cache_root.__wrapped__() is None
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "new" / "folder"))
    assert code_folders.cache_root.__wrapped__() == tmp_path / "new" / "folder" / FOLDER


def twice(x):
    return 2 * x


def test_without_a_place_code_is_compiled_and_not_kept(monkeypatch):
    monkeypatch.setattr(code_folders, "cache_root", lambda: None)
    compiled = cached_code(numba.njit)(twice)
    assert compiled(21) == 42
    assert compiled.stats.cache_path is None


def test_a_damaged_file_and_a_full_disk_cost_time_and_no_more(monkeypatch, tmp_path):
    monkeypatch.setattr(code_folders, "cache_root", lambda: tmp_path)
    assert cached_code(numba.njit)(twice)(21) == 42
    (file,) = tmp_path.rglob("*.code")
    file.write_bytes(file.read_bytes()[:100])
    again = cached_code(numba.njit)(twice)
    assert again(21) == 42
    assert not again.stats.cache_hits

    def full(path, content):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(code_folders, "write", full)
    assert cached_code(numba.njit)(twice)(21.5) == 43.0


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
        from numba import prange
        from other.rules import rule

        from mpmkit.kernels.compile import function, kernel
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
            @kernel()
            def scaled(x, out):
                for i in prange(len(x)):
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
import mpmkit.kernels.compile
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

    The process is forked from one that has loaded numba and compiled nothing, which saves a second each time.
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
    """The new value is used, wherever it comes from; with the old one back, the old code is found again."""
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
    """Of a plain Python function numba may have any other code; of its own cache it knows the file alone."""
    source = f"""
        import numba
        from numba import prange
        from mpmkit.kernels.compile import kernel

        def late():
            pass

        @{called}
        def other(x):
            return 5.0 * x

        @kernel()
        def scaled(x, out):
            for i in prange(len(x)):
                out[i] = other(x[i])
    """
    write_sources(tmp_path, {"plug/__init__.py": "", "plug/code.py": source})
    assert [fresh_run(tmp_path), fresh_run(tmp_path)] == [(5.0, 0, 1)] * 2


FACTOR = 2.0


def changing(x):
    return FACTOR * x


def test_a_constant_that_changes_within_a_process_is_not_kept_as_another(monkeypatch, tmp_path):
    """numba goes on with the old constant where it has compiled a function: so must nobody else."""
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
    """With ``fastmath`` the bits differ: kept code without it must not be taken for it, nor the other way."""
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
    """A folder called as our own ones were once deleted, with the results in it."""
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
    assert left(tmp_path / "cache") - {path.name for path in before} == {FOLDER}


OF_THE_KERNELS = """
import hashlib
import numpy as np
from mpmkit.registry import installed
from mpmkit.testing.specimens import Specimens, random_gradients
from test_transfers import Scene

found = []
for law in ("herschel-bulkley-evp", "herschel-bulkley"):
    material = installed().of_kind("law")[law](yield_stress=188.91, consistency=45.65, flow_index=1.33)
    found.append(Specimens(material, 300).drive(random_gradients(300), 0.2, 10))
scene = Scene(2, 3, n=300, affine=True)
grid = np.zeros((scene.count, 10))
scene.scatter(grid, True, True)
scene.gather(scene.rng.normal(size=grid.shape), move=True, strain=True, affine=True)
found += [grid, scene.velocity, scene.velocity_gradient, scene.affine]
print(*(hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest() for array in found))
"""
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


def twice_in_processes_of_their_own(script, folder, *arguments):
    """What each of the two prints: one that compiles, and one that finds its code."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder), "NUMBA_NUM_THREADS": "1"}
    return [in_a_process_of_its_own(script, environment, *arguments) for _ in range(2)]


def in_a_process_of_its_own(script, environment, *arguments):
    command = [sys.executable, "-c", script, *arguments]
    return subprocess.check_output(command, cwd=Path(__file__).parent, env=environment, text=True)


def test_kernels_just_compiled_and_kernels_that_were_kept_agree_to_the_bit(capsys):
    """The compiler goes over kept code once more: nothing may be left to its freedom to round otherwise.

    The kernels with the most arithmetic: of two laws, and from particles to nodes and back. On a machine that
    has no code yet, such as that of continuous integration, it is this process that has compiled them.
    """
    exec(OF_THE_KERNELS, {})
    environment = {**os.environ, "NUMBA_NUM_THREADS": "1"}
    kept = in_a_process_of_its_own(OF_THE_KERNELS, environment)
    assert capsys.readouterr().out == kept


@pytest.mark.slow
def test_kernels_agree_to_the_bit_whatever_code_there_is_on_this_machine(tmp_path):
    compiled, kept = twice_in_processes_of_their_own(OF_THE_KERNELS, tmp_path)
    assert compiled == kept


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments",
    [["slump_fast"], ["slump_quarter", *COARSE], ["slump_quarter", *COARSE, *REGULARISED]],
    ids=["axisymmetric", "3-D", "3-D, regularised"],
)
def test_scenes_of_code_just_compiled_and_of_code_that_was_kept_agree_to_the_bit(arguments, tmp_path):
    name, *changes = arguments
    case = Path(__file__).parents[1] / "cases" / f"{name}.json"
    compiled, kept = twice_in_processes_of_their_own(STEPS, tmp_path, str(case), *changes)
    assert compiled == kept


def test_a_function_is_compiled_once_for_all_constants_of_one_type():
    @cached_code(numba.njit)
    def power(x, exponent, inverse):
        return x**-exponent if inverse else x**exponent

    @cached_code(numba.njit)
    def both(x):
        return power(x, 2, False) + power(x, 3, False) + power(x, 1, True)

    assert both(2.0) == 4 + 8 + 0.5
    if not numba.config.DISABLE_JIT:
        assert len(power.overloads) == 1
