"""The sheet of the validation tests, and the report made from it."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
VALIDATION = ROOT / "tests" / "validation"
TESTS = """
import pytest
from bands import below, close_to

pytestmark = pytest.mark.section(4)

def test_right(validate):
    validate("right", 1.01, close_to(1.0, rel=0.02), unit="m")
    figure = validate.figure("drawn", "A title", x="x (m)", y="y (m)")
    figure.reference("exact", [0, 1], [0, 1])
    figure.points("found", [0, 1], [0.1, 0.9])

def test_wrong(validate):
    validate("wrong", 1.03, close_to(1.0, rel=0.02), unit="m")
    validate("not a number", float("nan"), below(1.0))
    validate("right all the same", 0.5, below(1.0))

def test_crashes(validate):
    validate("before the crash", 0.5, below(1.0))
    raise ValueError("of some kind")

@pytest.mark.xfail(strict=True)
def test_known(validate):
    validate("known to be wrong", 2.0, below(1.0))

@pytest.mark.parametrize("off", [0.1, 0.9, 0.3])
def test_thrice(validate, off):
    validate("thrice", off, below(1.0))

def test_silent():
    assert True
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A small suite of its own, run with and without a folder for its records."""
    folder = tmp_path_factory.mktemp("suite")
    for name in ("conftest.py", "sheet.py", "bands.py"):
        shutil.copy(VALIDATION / name, folder)
    (folder / "test_suite.py").write_text(TESTS)
    (folder / "pytest.ini").write_text("[pytest]\nmarkers =\n    slow: takes minutes\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(folder)]
    kept = {name: value for name, value in os.environ.items() if name != "MPMKIT_VALIDATION_RECORDS"}
    plain = subprocess.run(command, cwd=folder, env=kept, capture_output=True, text=True, check=False)
    before = sorted(path.name for path in folder.rglob("*.json"))
    recorded = kept | {"MPMKIT_VALIDATION_RECORDS": str(folder / "records")}
    found = subprocess.run(command, cwd=folder, env=recorded, capture_output=True, text=True, check=False)
    return folder, plain, before, found


@pytest.fixture(scope="module")
def report_package():
    sys.path.insert(0, str(ROOT / "docs"))
    try:
        from validation_report import figures, records, tables

        yield figures, records, tables
    finally:
        sys.path.remove(str(ROOT / "docs"))


def test_rows_decide_the_test(run):
    _, plain, before, found = run
    for one in (plain, found):
        assert "2 failed, 5 passed, 1 xfailed" in one.stdout, one.stdout + one.stderr
        assert "wrong: 1.03 m, expected 1 m (± 2 %)" in one.stdout
    assert before == []  # recording costs nothing unless asked for


def test_every_row_is_kept(run):
    folder, *_ = run
    sheets = [json.loads(path.read_text()) for path in (folder / "records").glob("*.json")]
    rows = {row["test"]: row["holds"] for sheet in sheets for row in sheet["rows"]}
    assert rows == {
        "right": True, "wrong": False, "not a number": False, "right all the same": True,
        "before the crash": True, "known to be wrong": False, "thrice": True,
    }  # fmt: skip


def test_report(run, report_package, tmp_path):
    folder, *_ = run
    figures, records, tables = report_package
    sheets = records.load(folder / "records")
    drawn = figures.draw(sheets, tmp_path)
    assert (tmp_path / "drawn.png").stat().st_size > 5000
    page = tables.report(sheets, drawn)
    assert "## 4. Limits and thresholds" in page
    assert "| right | 1 m | 1.01 m | ± 2 % | pass |" in page
    assert "| wrong | 1 m | 1.03 m | ± 2 % | **fail** |" in page
    assert "| known to be wrong | ≤ 1 | 2 | ≤ 1 | **fail** (known) |" in page
    assert "| `test_crashes` |  | of some kind |  | **did not finish** |" in page
    assert "| thrice (3 runs) | ≤ 1 | 0.9 | ≤ 1 | pass |" in page
    assert "1 more test, without a number of its own, passed." in page
    assert "![A title](images/validation/drawn.png)" in page
    assert str(folder) not in page
    assert tables.tally(sheets) == "8 lines, 4 within their band, 4 not."


def test_interrupted_test_says_so(report_package):
    _, _, tables = report_package
    sheet = {
        "test": "test_x.py::test_y", "section": 4, "status": "running", "message": "", "seconds": 0.0,
        "slow": False, "version": "1.2.3", "rows": [], "curves": [],
    }  # fmt: skip
    assert "| `test_y` |  | interrupted |  | **did not finish** |" in tables.report([sheet], [])
