"""mpmkit inside another program: threads, processes, environment and encodings of the caller."""

from __future__ import annotations

import copy
import json
import os
import pickle
import subprocess
import sys
import threading
from pathlib import Path

import numba
import pytest

import mpmkit
from mpmkit.case import load_case, parse_case
from mpmkit.cli import main
from mpmkit.errors import GuardStop
from mpmkit.plan import plan

CASE = {
    "name": "guest",
    "space": "plane-strain",
    "until": 0.02,
    "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]},
            "material": {"law": "newtonian", "density": 1000, "viscosity": 10, "sound_speed": 20},
        }
    ],
    "output": {"report": False},
}
SHIPPED = sorted((Path(__file__).parents[1] / "cases").glob("*.json"))


# --- Threads


def test_more_threads_than_there_are_is_a_warning(caplog):
    most = numba.config.NUMBA_NUM_THREADS
    history = mpmkit.run(parse_case(CASE), threads=1000)
    assert f"threads is 1000, but only {most} can be used here" in caplog.text
    assert json.loads(history.attrs["machine"])["threads"] == most


@pytest.mark.parametrize("use", [mpmkit.run, plan])
def test_the_caller_s_number_of_threads_comes_back(use):
    for before in (1, 2):
        numba.set_num_threads(before)
        use(parse_case(CASE), threads=3 - before)
        assert numba.get_num_threads() == before


def test_two_runs_at_once_each_have_a_log_of_their_own(tmp_path):
    """Both are at work at the same time: each waits in its first step for the other."""
    barrier = threading.Barrier(2, timeout=60)

    def run(name):
        waited = []

        def listen(progress):
            if not waited:
                waited.append(barrier.wait())

        mpmkit.run(parse_case(CASE | {"name": name}), tmp_path / name, listen=listen, threads=1)

    workers = [threading.Thread(target=run, args=(name,)) for name in ("first", "second")]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join(120)
    for name, other in (("first", "second"), ("second", "first")):
        log = (tmp_path / name / "run.log").read_text()
        assert f"{name}: 64 particles" in log
        assert log.count("finished after") == 1
        assert f"{other}: " not in log


# --- A case in other hands


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_case_is_equal_to_its_copies(path):
    case, again = load_case(path), load_case(path)
    for one in (case, again):  # what they compute is kept, and does not make them differ
        assert len(one.gravity_vector) == len(one.domain_bounds[0]) == case.space_.dim
    for other in (again, copy.copy(case), copy.deepcopy(case), pickle.loads(pickle.dumps(case))):
        assert other == case
        assert type(other) is type(case)
    assert load_case(path, ["until=0.001"]) != case
    assert case != path


def in_python(code: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
        env=os.environ | environment,
    )


POOL = """
import json, multiprocessing, sys
import mpmkit
case = mpmkit.parse_case(json.loads(sys.argv[1]) if len(sys.argv) > 1 else {case!r})
if __name__ == "__main__":
    if {before}:
        mpmkit.run(case)
    with multiprocessing.get_context("{how}").Pool(1) as pool:
        try:
            print([history.sizes["time"] for history in pool.map_async(mpmkit.run, [case, case]).get(120)])
        except mpmkit.errors.MpmkitError as error:
            print(error)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a system that forks")
def test_a_pool_that_was_forked_after_a_run_says_why_it_cannot_run():
    done = in_python(POOL.format(case=CASE, how="fork", before=True))
    assert done.stdout.startswith("mpmkit cannot run here: this process was forked from one that had used"), (
        done
    )
    assert "get_context('spawn')" in done.stdout


@pytest.mark.parametrize(("how", "before"), [("fork", False), ("spawn", True)])
def test_a_pool_that_can_run_does(how, before):
    done = in_python(POOL.format(case=CASE, how=how, before=before))
    rows = mpmkit.run(parse_case(CASE)).sizes["time"]
    assert done.stdout == f"[{rows}, {rows}]\n", done


def test_a_guard_s_stop_can_leave_its_process():
    stop = pickle.loads(pickle.dumps(GuardStop("energy", "stopped at step 3", step=3, particle=7)))
    assert (str(stop), stop.guard, stop.step, stop.particle) == ("stopped at step 3", "energy", 3, 7)


# --- The environment


@pytest.mark.parametrize(
    ("variable", "value", "command"),
    [
        ("NUMBA_NUM_THREADS", "0", "run"),
        ("NUMBA_NUM_THREADS", "two", "plugins"),
        ("NUMBA_NUM_THREADS", "-1", "run"),
        ("NUMBA_THREADING_LAYER", "none", "run"),
        ("NUMBA_THREADING_LAYER", "none", "plugins"),
    ],
)
def test_threads_that_cannot_be_are_one_sentence(tmp_path, variable, value, command):
    (tmp_path / "case.json").write_text(json.dumps(CASE))
    arguments = [command, "case.json"] if command == "run" else [command]
    done = subprocess.run(
        [sys.executable, "-m", "mpmkit", *arguments],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {variable: value},
    )
    assert done.returncode == 2
    assert done.stderr.startswith(f"mpmkit: the environment variable {variable} is '{value}'")
    assert len(done.stderr.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["case.json"]


COMMANDS = """
import sys
from mpmkit.cli import main
for arguments in (["run", "case.json"], ["plan", "case.json"], ["schema"]):
    try:
        main(arguments)
    except SystemExit as end:
        assert not end.code, arguments
    sys.stdout.flush()
    sys.stdout.buffer.write(b"\\0")
"""


@pytest.mark.parametrize("encoding", ["latin-1", "ascii"])
def test_an_encoding_that_lacks_our_characters(tmp_path, encoding):
    """Three commands, one after the other in one process: what costs time is to start one."""
    (tmp_path / "case.json").write_text(json.dumps(CASE))
    done = subprocess.run(
        [sys.executable, "-c", COMMANDS],
        cwd=tmp_path,
        capture_output=True,
        check=False,
        env=os.environ | {"PYTHONIOENCODING": encoding},
    )
    assert done.returncode == 0, done.stderr
    assert b"Traceback" not in done.stderr
    # click takes an output in ASCII for one that was set up wrongly, and writes UTF-8 to it.
    said = done.stdout.decode("utf-8" if encoding == "ascii" else encoding)
    run, planned, schema, _ = said.split("\0")
    assert "T500" in run
    assert "results in runs" in run
    assert "particles" in planned
    assert "√(2 g h)" in json.dumps(json.loads(schema), ensure_ascii=False)  # JSON loses nothing


def test_json_is_as_it_is_in_utf_8(capsys):
    with pytest.raises(SystemExit):
        main(["schema"])
    assert "√" in capsys.readouterr().out
