"""Random cases: valid ones run, others end with status 2 and one sentence.

A quick run draws a few hundred, always the same; ``pytest -m slow tests/fuzz`` draws thousands of new ones.
"""

from __future__ import annotations

import json
import os
import platform
import sys
import tempfile
import time
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from fuzz_cases import PAYLOADS, TRICKS, broken_texts, invalid_cases, junk, mutants, valid_cases
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mpmkit.case import load_case, parse_case
from mpmkit.cli import main
from mpmkit.errors import CaseError, GuardStop, MpmkitError
from mpmkit.kernels.code_folders import cache_root
from mpmkit.solver.memory import expected_particles, require_memory
from mpmkit.solver.simulation import Simulation

THOUSANDS = int(os.environ.get("MPMKIT_FUZZ", "3000"))
"""Examples of each slow test."""
SECONDS = 20.0
"""No bad case may take longer to be refused: the first one compiles nothing, but may wait for its core."""
MOST = 3000
"""Particles of a mutant that is run, should it be valid."""
CODE = os.path.realpath(cache_root() or tempfile.gettempdir())
"""Folder of compiled kernels, which a run may write."""
FORBIDDEN = ("os.system", "os.exec", "os.posix_spawn", "os.fork", "subprocess.Popen", "pickle.find_class",
             "socket.connect")  # fmt: skip

quick = settings(
    max_examples=60, derandomize=True, deadline=None, database=None,
    suppress_health_check=list(HealthCheck),
)  # fmt: skip
few = settings(quick, max_examples=20)
"""Of what starts a run each time."""
long = settings(quick, max_examples=THOUSANDS, derandomize=False)
watched: dict = {"on": False, "done": [], "inside": ""}


def _watch(event: str, arguments: tuple) -> None:
    if not watched["on"]:
        return
    if event in FORBIDDEN:
        watched["done"].append((event, arguments))
    elif event == "open":
        path, mode, flags = arguments
        writes = flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT) if isinstance(flags, int) else "r" not in mode
        if writes and isinstance(path, str | bytes | os.PathLike):
            where = os.path.realpath(os.fsdecode(path))
            caches = (str(Path.home() / ".cache"), CODE)
            if not where.startswith((watched["inside"], *caches, "/dev/null", sys.prefix)):
                watched["done"].append((event, where, mode))


sys.addaudithook(_watch)


@contextmanager
def nothing_done(inside: Path, but: tuple[str, ...] = ()):
    """Nothing in the block may write outside a directory, start a process, unpickle or use the network.

    ``but`` is what it may do all the same: a run loads kernels that numba has pickled.
    """
    watched.update(on=True, done=[], inside=str(inside.resolve()))
    try:
        yield
    finally:
        watched["on"] = False
    assert [done for done in watched["done"] if done[0] not in but] == []


def command(*arguments: str) -> tuple[int, list[str]]:
    """Exit status of the command line, and the lines on standard error."""
    errors = StringIO()
    with redirect_stderr(errors), redirect_stdout(StringIO()), pytest.raises(SystemExit) as stop:
        main(list(arguments))
    return stop.value.code, errors.getvalue().splitlines()


def require_sentence(status: int, lines: list[str]) -> None:
    assert status == 2, (status, lines)
    assert len(lines) == 1, lines
    assert lines[0].startswith("mpmkit: ")
    assert len(lines[0]) < 2000
    assert "Traceback" not in lines[0]


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_three_steps(data: dict) -> None:
    simulation = Simulation(parse_case(data))
    p = simulation.particles
    mass = p.mass.sum()
    for _ in range(3):
        simulation.advance()
    simulation.check()
    assert simulation.steps == 3
    assert simulation.time > 0
    assert p.mass.sum() == pytest.approx(mass, rel=1e-12)
    for name, array in p.arrays().items():
        assert np.isfinite(array).all(), name


def refused(data: dict, here: Path) -> None:
    (here / "case.json").write_text(json.dumps(data), encoding="utf-8")
    begin = time.monotonic()
    with nothing_done(here):
        require_sentence(*command("run", "case.json", "--quiet"))
    assert time.monotonic() - begin < SECONDS
    assert [path.name for path in here.iterdir()] == ["case.json"]


def survived(data: dict, here: Path) -> None:
    """Refused with one sentence, or good for three steps or a guard's stop; never anything else."""
    try:
        with nothing_done(here):
            case = parse_case(data)
            require_memory(case)
            few = expected_particles(case) < MOST
        with nothing_done(here, but=("pickle.find_class",)):
            simulation = Simulation(case) if few else None
            for _ in range(3 if few else 0):
                simulation.advance()
    except (CaseError, GuardStop) as error:
        assert 20 < len(str(error)) < 2000  # noqa: PT017
        assert "Traceback" not in str(error)  # noqa: PT017
    assert {path.name for path in here.iterdir()} <= {"case.json"}


def ended(data: dict, here: Path) -> None:
    """From the command line, for a few steps: done, refused, or stopped by a guard that leaves its run."""
    if (shortened := _shortened(data)) is None:
        return
    platform.processor()  # it starts a process, and keeps what that says: a run writes it down
    with tempfile.TemporaryDirectory(dir=here) as place:
        directory = Path(place)
        (directory / "case.json").write_text(json.dumps(shortened), encoding="utf-8")
        with nothing_done(directory, but=("pickle.find_class",)):
            arguments = ("run", f"{directory}/case.json", "--quiet", "--threads", "1")
            status, lines = command(*arguments, "--out", f"{directory}/out")
        if status == 2:
            require_sentence(status, lines)
            assert [path.name for path in directory.iterdir()] == ["case.json"]
            return
        assert status in (0, 3), (status, lines)
        assert "Traceback" not in "".join(lines)
        kept = {path.name for path in (directory / "out").iterdir()}
        assert {"case.json", "history.nc", "summary.json", "run.log"} <= kept
        summary = json.loads((directory / "out/summary.json").read_text())
        assert (summary["stopped_because"] == "finished") == (status == 0), summary
        if status == 3:
            assert "stopped at step" in lines[-1]


def _shortened(data: dict) -> dict | None:
    """The case up to five of its first steps, or as it is if it cannot be set up; None if it is too large."""
    try:
        case = parse_case(data)
        require_memory(case)
        if expected_particles(case) >= MOST:
            return None
        simulation = Simulation(case)
        simulation.choose_time_step()
    except MpmkitError:
        return data
    return data | {"until": min(data["until"], 5 * simulation.time_step), "output": {"report": False}}


def text_survived(text: bytes, here: Path) -> None:
    (here / "case.json").write_bytes(text)
    begin = time.monotonic()
    good = False
    with nothing_done(here):
        try:
            load_case("case.json")
            good = True
        except CaseError:
            require_sentence(*command("run", "case.json", "--quiet"))
    if good:  # what was broken was not what matters
        survived(json.loads(text), here)
    assert time.monotonic() - begin < SECONDS


# --- A few, always the same


@given(valid_cases(walled=False))
@quick
def test_valid_cases_run_three_steps(data):
    with np.errstate(all="ignore"):
        run_three_steps(data)


@given(data=invalid_cases())
@quick
def test_invalid_cases_are_refused_in_one_sentence(here, data):
    refused(data, here)


@given(data=mutants())
@quick
def test_mutants_are_refused_or_run(here, data):
    with np.errstate(all="ignore"):
        survived(data, here)


@given(data=mutants(walled=True))
@few
def test_cases_with_walls_end_as_they_should(here, data):
    with np.errstate(all="ignore"):
        ended(data, here)


@given(text=broken_texts())
@quick
def test_broken_texts_are_refused_or_run(here, text):
    text_survived(text, here)


@given(data=valid_cases(), path=st.text(max_size=30), value=junk() | st.text(max_size=10))
@quick
def test_overrides_are_refused_or_taken(data, path, value):
    text = value if isinstance(value, str) else json.dumps(value)
    try:
        parse_case(data, [f"{path}={text}"])
    except MpmkitError as error:
        assert error.exit_status == 2  # noqa: PT017
        assert len(str(error)) < 2000  # noqa: PT017


@pytest.mark.parametrize("name", TRICKS)
def test_a_name_that_leads_elsewhere_is_refused(here, name):
    data = {"name": name}
    (here / "case.json").write_text(json.dumps(data))
    with nothing_done(here):
        status, lines = command("run", "case.json")
    require_sentence(status, lines)
    assert "name" in lines[0]


@pytest.mark.parametrize("text", PAYLOADS)
def test_texts_are_nothing_but_texts(here, text):
    """In every place of a case that takes a text, or a key."""
    material = {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 10}
    case = {
        "space": "3d", "until": 0.001, "description": text, "$schema": text,
        "grid": {"cell_size": 0.1, "domain": {axis: [0, 1] for axis in "xyz"}},
        "bodies": [{"shape": {"kind": "mesh", "file": text}, "material": material}],
    }  # fmt: skip
    (here / "case.json").write_text(json.dumps(case))
    with nothing_done(here):
        status, lines = command("run", "case.json")
        require_sentence(status, lines)
        assert "bodies.0.shape" in lines[0]
        for key in ("space", "scheme", "bodies"):
            (here / "case.json").write_text(json.dumps(case | {key: text}))
            require_sentence(*command("run", "case.json"))
        require_sentence(*command("run", "case.json", "--set", f"scheme.order={text}"))
    assert [path.name for path in here.iterdir()] == ["case.json"]


# --- Thousands


@pytest.mark.slow
@given(valid_cases(walled=False))
@long
def test_thousands_of_valid_cases_run_three_steps(data):
    with np.errstate(all="ignore"):
        run_three_steps(data)


@pytest.mark.slow
@given(data=invalid_cases())
@long
def test_thousands_of_invalid_cases_are_refused_in_one_sentence(here, data):
    refused(data, here)


@pytest.mark.slow
@given(data=mutants())
@long
def test_thousands_of_mutants_are_refused_or_run(here, data):
    with np.errstate(all="ignore"):
        survived(data, here)


@pytest.mark.slow
@given(data=mutants(walled=True))
@long
def test_thousands_of_cases_with_walls_end_as_they_should(here, data):
    with np.errstate(all="ignore"):
        ended(data, here)


@pytest.mark.slow
@given(text=broken_texts())
@long
def test_thousands_of_broken_texts_are_refused_or_run(here, text):
    text_survived(text, here)
