"""docs/validation.md: a table for every section of the targets."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterator
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path

from .records import Sheet

SECTIONS = {
    1: "Laws, one particle",
    2: "Profiles",
    3: "The slump test",
    4: "Limits and thresholds",
    5: "The method itself",
    6: "Faces of the domain",
    7: "In and out",
    8: "Tests of the laboratory",
    0: "Everything else",
}
PASS, FAIL, KNOWN, CRASH = "pass", "**fail**", "**fail** (known)", "**did not finish**"
HEAD = """# Validation

What the tests in `tests/validation` measured, next to what it should be. "Expected" is exact, derived from
the equations, or an independent solution; a band says how far off a number may be and still be called right.
Where several runs stand behind a line, the one closest to the edge of its band is shown. Nothing is left
out: a number outside its band stays in as failed.

Written by `python docs/validation.py`; do not edit.
"""


@dataclass
class Line:
    """One line of a table: the worst of the rows that share its name."""

    test: str
    expected: str
    obtained: str
    band: str
    verdict: str
    used: float
    runs: int = 1

    def worse_than(self, other: Line) -> bool:
        return (self.verdict != PASS, self.used) > (other.verdict != PASS, other.used)


@dataclass
class Section:
    title: str
    lines: dict[str, Line] = field(default_factory=dict)
    figures: list[tuple[str, str, str]] = field(default_factory=list)
    silent: int = 0
    skipped: int = 0

    def add(self, line: Line) -> None:
        other = self.lines.get(line.test)
        if other is None:
            self.lines[line.test] = line
            return
        worst = line if line.worse_than(other) else other
        worst.runs = other.runs + 1
        self.lines[line.test] = worst


def lines_of(sheet: Sheet) -> Iterator[tuple[int, Line]]:
    """Every row of a sheet, and a line of its own for a test that stopped by itself."""
    known = "expected to fail" in sheet["status"]
    for row in sheet["rows"]:
        verdict = PASS if row["holds"] else KNOWN if known else FAIL
        used = row["used"] if row["used"] is not None else 0.0 if row["holds"] else float("inf")
        yield (
            row["section"],
            Line(row["test"], row["expected"], row["obtained"], row["band"], verdict, used),
        )
    missed = any(not row["holds"] for row in sheet["rows"])
    if sheet["status"] not in ("passed", "skipped") and not (missed and sheet["status"] != "crashed"):
        name = sheet["test"].split("::", 1)[1]
        said = {"running": "interrupted"}.get(sheet["status"], sheet["message"])
        verdict = {"failed": FAIL, "expected to fail": KNOWN}.get(sheet["status"], CRASH)
        if sheet["status"] == "passed though expected to fail":
            verdict = FAIL
        yield sheet["section"], Line(f"`{name}`", "", _without_paths(said), "", verdict, float("inf"))


def collect(sheets: list[Sheet], drawn: list[tuple[int, str, str, str]]) -> dict[int, Section]:
    sections = {number: Section(title) for number, title in SECTIONS.items()}
    for sheet in sheets:
        lines = list(lines_of(sheet))
        for number, line in lines:
            sections[number].add(line)
        if not lines and sheet["status"] == "passed":
            sections[sheet["section"]].silent += 1
        sections[sheet["section"]].skipped += sheet["status"] == "skipped"
    for number, name, title, caption in drawn:
        sections[number].figures.append((name, title, caption))
    return sections


def report(sheets: list[Sheet], drawn: list[tuple[int, str, str, str]]) -> str:
    """The whole page."""
    parts = [HEAD, f"{tally(sheets)}\n", machine(sheets)]
    for number, section in collect(sheets, drawn).items():
        if not (section.lines or section.silent or section.skipped or section.figures):
            continue
        parts.append(f"## {number}. {section.title}\n" if number else f"## {section.title}\n")
        if section.lines:
            parts.append(_table(section))
        if section.silent or section.skipped:
            parts.append(_remarks(section))
        for name, title, caption in section.figures:
            parts.append(f"![{title}](images/validation/{name}.png)\n")
            if caption:
                parts.append(f"{caption}\n")
    return "\n".join(parts)


def _table(section: Section) -> str:
    rows = ["| test | expected | obtained | band | verdict |", "|---|---|---|---|---|"]
    for line in section.lines.values():
        runs = f" ({line.runs} runs)" if line.runs > 1 else ""
        cells = (line.test + runs, line.expected, line.obtained, line.band, line.verdict)
        rows.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(rows) + "\n"


def _remarks(section: Section) -> str:
    remarks = []
    if section.silent == 1:
        remarks.append("1 more test, without a number of its own, passed.")
    elif section.silent:
        remarks.append(f"{section.silent} more tests, without numbers of their own, passed.")
    if section.skipped:
        remarks.append(f"**Not measured: {section.skipped} that were skipped.**")
    return " ".join(remarks) + "\n"


def tally(sheets: list[Sheet]) -> str:
    verdicts = [line.verdict for section in collect(sheets, []).values() for line in section.lines.values()]
    missed = len(verdicts) - verdicts.count(PASS)
    return f"{len(verdicts)} lines, {verdicts.count(PASS)} within their band, {missed} not."


def machine(sheets: list[Sheet]) -> str:
    """What it ran with and on."""
    measured_with = " and ".join(sorted({sheet["version"] for sheet in sheets}))
    versions = ", ".join(f"{name} {version(name)}" for name in ("numpy", "numba", "matplotlib"))
    minutes = sum(sheet["seconds"] for sheet in sheets) / 60
    slow = sum(sheet["slow"] for sheet in sheets)
    return (
        f"mpmkit {measured_with}, {versions}, Python {platform.python_version()}; {platform.system()} on "
        f"{_processor()}, {os.cpu_count()} cores, one thread. {len(sheets)} tests, {slow} of them slow, "
        f"{minutes:.1f} minutes together.\n"
    )


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.machine()


def _without_paths(text: str) -> str:
    root = str(Path(__file__).parents[2])
    return text.replace(root + os.sep, "").replace(str(Path.home()), "~").replace("\n", " ")
