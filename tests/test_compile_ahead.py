"""Other processes compile the functions of a run ahead of it; the run does not depend on their success."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest
from numba import types

from mpmkit.case import load_case
from mpmkit.kernels import code_folders
from mpmkit.kernels.ahead import Ahead, claim
from mpmkit.kernels.compile import chunk_count
from mpmkit.kernels.gather import gather
from mpmkit.kernels.needs import Need, Unnamed, need_of
from mpmkit.kernels.sort import permute
from mpmkit.running.ahead import needs_of, recorded

ROOT = Path(__file__).parents[1]
ROWS = types.Array(types.float64, 2, "C")


def code_of(function, signature):
    return function._cache.path(signature, function.targetctx)


@pytest.fixture
def empty_cache(tmp_path, monkeypatch):
    """No code is kept yet, neither for this process nor for those that it starts."""
    root = tmp_path / code_folders.FOLDER
    root.mkdir()
    monkeypatch.setattr(code_folders, "cache_root", lambda: root)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    return root


def test_a_need_as_text_names_the_same_function_and_types():
    strided = types.Array(types.int32, 1, "A", readonly=True)
    signature = (ROWS, strided, types.float64, types.boolean, types.int64, types.UniTuple(types.int64, 3))
    for function in (permute, gather(2, 3), gather(3, 2)):
        need = Need(**need_of(function, signature).as_dict())
        assert need.function().py_func.__qualname__ == function.py_func.__qualname__
        assert need.signature() == signature
        assert code_of(need.function(), signature).name == code_of(function, signature).name


def test_what_text_cannot_say_is_refused_and_not_guessed():
    with pytest.raises(Unnamed):
        need_of(permute, (types.Omitted(1.0),))
    with pytest.raises(Unnamed):
        Need("mpmkit.kernels.sort", "no_such_function", {}, ()).function()
    with pytest.raises(Unnamed):
        Need("no_such_package", "permute", {}, ()).function()


def test_another_process_compiles_what_is_needed_and_this_one_loads_it(empty_cache):
    code, other = code_of(chunk_count, (types.int64,)), code_of(chunk_count, (types.int32,))
    ahead = Ahead()
    ahead.expect([need_of(chunk_count, (types.int64,))], 1)
    assert not empty_cache.exists() or not code.exists()
    try:
        assert not ahead.compiles(other)  # the first function that is missing starts the process
        until = time.monotonic() + 60
        while not code.exists() and time.monotonic() < until:
            time.sleep(0.05)
        assert ahead.compiles(code)
    finally:
        ahead.end()


def test_a_process_that_died_over_its_work_costs_no_more_than_time(empty_cache, tmp_path):
    ahead = Ahead()
    ahead.expect([Need("no_such_package", "f", {}, ())], 1)
    code = code_of(chunk_count, (types.int64,))
    try:
        assert not ahead.compiles(code_of(chunk_count, (types.int32,)))
        (process,) = ahead._processes
        claim(Path(ahead._folder.name), code)  # as it had begun with
        process.kill()
        process.wait()
        assert not ahead.compiles(code)  # so this process compiles it
    finally:
        ahead.end()


def test_nothing_is_started_where_nothing_is_missing_or_there_is_one_core(empty_cache):
    ahead = Ahead()
    ahead.expect([need_of(chunk_count, (types.int64,))], 0)
    assert not ahead.compiles(code_of(chunk_count, (types.int64,)))
    assert not ahead._processes


def test_every_recorded_need_still_has_its_function_and_types():
    for entry in recorded()["functions"]:
        need = Need(**entry)
        assert need.function().py_func.__module__ == need.module
        assert len(need.signature()) == len(need.types)


def test_a_case_takes_the_record_of_the_most_similar_one():
    record = recorded()
    for of in record["cases"]:
        case = load_case(ROOT / "cases" / f"{of['case']}.json")
        assert [need.as_dict() for need in needs_of(case)] == [
            record["functions"][k] for k in [*reversed(of["first"]), *of["later"]]
        ]


@pytest.mark.slow
@pytest.mark.parametrize("name", [of["case"] for of in recorded()["cases"]])
def test_the_record_has_what_a_first_step_needs(name):
    """If this fails, kernels have changed: run ``python benchmarks/needed_kernels.py``."""
    script = ROOT / "benchmarks" / "needed_kernels.py"
    command = [sys.executable, script, "--case", name, "--until", "1e-4"]
    for _ in range(2):  # the first may have to compile
        said = subprocess.run(command, check=True, capture_output=True, text=True)
    record = recorded()
    (of,) = [of for of in record["cases"] if of["case"] == name]
    kept = [record["functions"][number] for number in (*of["first"], *of["later"])]
    missing = [need for need in json.loads(said.stdout.splitlines()[-1])["first"] if need not in kept]
    assert len(missing) <= 0.1 * len(of["first"]), missing
