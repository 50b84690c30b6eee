"""Measure everything that the validation tests vouch for, and write docs/validation.md and its figures,
docs/images/validation/*.png.

    python docs/validation.py             # all of it, the slow tests too
    python docs/validation.py --fast      # without the slow ones
    python docs/validation.py --only EXPR # again what pytest's -k EXPR picks, the rest from the last run
    python docs/validation.py --resume    # only what an interrupted run did not get to
    python docs/validation.py --draw      # nothing: write the report of what was measured before

What a test measures is kept as it goes in runs/validation, one file a test.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

from validation_report import figures, records, tables

ROOT = Path(__file__).parents[1]
RECORDS = ROOT / "runs" / "validation"
REPORT = ROOT / "docs" / "validation.md"
IMAGES = ROOT / "docs" / "images" / "validation"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--fast", action="store_true", help="leave out the slow tests")
    parser.add_argument("--only", metavar="EXPR", help="pytest's -k: run these tests, keep the rest")
    parser.add_argument("--resume", action="store_true", help="leave out tests that have come to an end")
    parser.add_argument("--draw", action="store_true", help="run nothing")
    return parser.parse_args()


def measure(chosen: argparse.Namespace) -> int:
    """Run the tests; returns pytest's exit status."""
    if not (chosen.only or chosen.resume):
        records.clear(RECORDS)
    one_by_one = ["-p", "no:xdist"]  # so that the times of the tests mean something
    command = [sys.executable, "-m", "pytest", "tests/validation", "-q", *one_by_one]
    command += ["-m", "not slow" if chosen.fast else "slow or not slow"]
    if chosen.only:
        command += ["-k", chosen.only]
    environment = os.environ | {"MPMKIT_VALIDATION_RECORDS": str(RECORDS)}
    if chosen.resume:
        environment["MPMKIT_VALIDATION_RESUME"] = "1"
    return subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode


def main() -> None:
    chosen = arguments()
    status = 0 if chosen.draw else measure(chosen)
    sheets = records.load(RECORDS)
    if not sheets:
        print(f"{RECORDS} holds no measurements: nothing was written", file=sys.stderr)
        sys.exit(2)
    drawn = figures.draw(sheets, IMAGES)
    REPORT.write_text(tables.report(sheets, drawn), encoding="utf-8")
    print(f"{REPORT.relative_to(ROOT)}: {tables.tally(sheets)}")
    nothing_wrong = (0, 1, 5)  # 1: failed rows, which are in the report; 5: nothing was left to run
    sys.exit(0 if status in nothing_wrong else status)


if __name__ == "__main__":
    main()
