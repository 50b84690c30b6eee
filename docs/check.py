"""Check that the docs are whole; prints what is not, and ends with status 1 if there is anything.

    python docs/check.py                       # marks of merges, dead links, missing files, figures
                                               # without a script, phrases that few understand, commands,
                                               # options and keys of a case that do not exist
    python docs/check.py --scripts             # and that every script has a help that writes nothing
    python docs/check.py --run runs/slump      # and that the README's numbers are those of this run

Continuous integration calls it with all of them.
"""

from __future__ import annotations

import argparse
import ast
import csv
import fnmatch
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
REFERENCE = ROOT / "tests/validation/reference/slump_free_slip_herschel_bulkley.csv"
MARK = re.compile(r"^(<{7}|>{7}|\|{7})( |$)", re.MULTILINE)
LINK = re.compile(r"\]\(([^)\s]+)\)")
IMAGE = re.compile(r"docs/images/[\w/*.]+\.png")
FILE = re.compile(r"`((?:mpmkit|plugins|tests|docs|cases|benchmarks)/[\w/.-]+\.\w+)`")
TEST = re.compile(r"`(test_\w+\.py)`")
RIDDLES = (
    "unless told",
    "told of",
    "hears of",
    "hear of",
    "numbers that are none",
    "what a scene needs",
    "say the same",
    "said the same",
    "can hardly be meant",
    "made one's own",
    "no more of it than",
    "as may be",
)
"""Phrases that a reader must read twice; the field's words say the same thing at once."""
ROUNDED = 0.6
"""Of the last digit given: by how much a number may be off that is said rounded."""
README_NUMBERS = re.compile(
    r"T500 ([\d.]+) s, spread ([\d.]+) m, where an independent incompressible finite-element solution has "
    r"([\d.]+) s and ([\d.]+) m".replace(" ", r"\s+")
)


def tracked(*patterns: str) -> list[Path]:
    """Files of the repository."""
    found = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns],
        cwd=ROOT, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return [path for line in found.stdout.splitlines() if (path := ROOT / line).is_file()]


def merge_marks() -> Iterator[str]:
    for path in tracked():
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        for mark in MARK.finditer(text):
            yield f"{_named(path)}:{text.count(chr(10), 0, mark.start()) + 1}: the mark of a merge"


def dead_links() -> Iterator[str]:
    for page in tracked("*.md"):
        if page.name.endswith(".template.md"):  # its links count from where the page will stand
            continue
        for target in LINK.findall(_without_code(page.read_text(encoding="utf-8"))):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, anchor = target.partition("#")
            path = (page.parent / file).resolve() if file else page
            if not path.exists():
                yield f"{_named(page)}: there is no '{target}'"
            elif anchor and anchor not in anchors(path):
                yield f"{_named(page)}: there is no heading '#{anchor}' in '{_named(path)}'"


def files_that_are_not_there() -> Iterator[str]:
    """Files that a page names in ``code``, such as those that compute the equations of the theory."""
    for page in tracked("README.md", "CONTRIBUTING.md", "docs/*.md"):
        for name in FILE.findall(page.read_text(encoding="utf-8")):
            if not (ROOT / name).exists():
                yield f"{_named(page)}: there is no file '{name}'"
        for name in TEST.findall(page.read_text(encoding="utf-8")):
            if not list(ROOT.glob(f"tests/**/{name}")):
                yield f"{_named(page)}: there is no test file '{name}'"


def names_that_do_not_exist() -> Iterator[str]:
    """Commands, options and keys of a case on the pages; the changelog may name old ones."""
    from dead_names import dead_names  # only here: it loads the command line of mpmkit

    for page in tracked("*.md"):
        if page.name != "CHANGELOG.md":
            for said in dict.fromkeys(dead_names(page.read_text(encoding="utf-8"))):
                yield f"{_named(page)}: {said}"


def riddles() -> Iterator[str]:
    """Phrases that few understand, on the pages and in messages and docstrings of the program."""
    for path in tracked("README.md", "CONTRIBUTING.md", "docs/*.md", "mpmkit/*.py", "plugins/*.py"):
        text = path.read_text(encoding="utf-8")
        plain = re.sub(r"\s+", " ", text).lower()
        for phrase in RIDDLES:
            if re.search(rf"\b{phrase}\b", plain):
                yield f"{_named(path)}: '{phrase}' is hard to understand; say it in plain words"


def anchors(page: Path) -> set[str]:
    """Names of the headings of a page, as Markdown renderers make them."""
    headings = re.findall(r"^#+ (.+)$", _without_code(page.read_text(encoding="utf-8")), re.MULTILINE)
    plain = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in headings)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in plain}


def figures_without_a_source() -> Iterator[str]:
    """Every picture is named in the docstring of the script that makes it, and shown on a page."""
    made = [name for script in scripts() for name in IMAGE.findall(_docstring(script))]
    pages = {page: page.read_text(encoding="utf-8") for page in tracked("*.md")}
    shown = {(page.parent / link).resolve() for page, text in pages.items() for link in LINK.findall(text)}
    shown |= {picture.resolve() for picture in gallery()}
    for picture in tracked("docs/images/*.png"):
        name = picture.relative_to(ROOT).as_posix()
        if not any(fnmatch.fnmatch(name, pattern) for pattern in made):
            yield f"{name}: no script names it in its docstring as what it makes"
        if picture.resolve() not in shown:
            yield f"{name}: no page shows it"


def gallery() -> list[Path]:
    """Pictures of the cases, which the gallery of the site shows."""
    entries = DOCS / "gallery.json"
    if not entries.exists():
        return []
    found = json.loads(entries.read_text(encoding="utf-8"))
    return [DOCS / "images" / entry.get("picture", f"gallery/{name}.png") for name, entry in found.items()]


def cases_that_the_gallery_lacks() -> Iterator[str]:
    """Every case in ``cases/`` has an entry in the gallery, and every entry a case and a picture."""
    named = set(json.loads((DOCS / "gallery.json").read_text(encoding="utf-8")))
    shipped = {case.stem for case in tracked("cases/*.json") if case.parent.name == "cases"}
    for name in sorted(named ^ shipped):
        yield f"docs/gallery.json: '{name}' is only {'there' if name in named else 'in cases/'}"
    for picture in gallery():
        if not picture.exists():
            yield f"docs/gallery.json: there is no '{_named(picture)}'"


def scripts() -> list[Path]:
    """Scripts of the docs and the benchmarks, without the modules that they import from each other."""
    return [
        path
        for path in tracked("docs/*.py", "benchmarks/*.py")
        if '__name__ == "__main__"' in path.read_text("utf-8")
    ]


def scripts_without_help() -> Iterator[str]:
    """Every script has a help, and asking for it changes no file."""
    for script in scripts():
        before = _state()
        asked = subprocess.run(
            [sys.executable, script, "--help"],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
            timeout=120,
        )
        if asked.returncode != 0 or "usage:" not in asked.stdout:
            yield f"{_named(script)}: --help ends with status {asked.returncode} and no help"
        if _state() != before:
            yield f"{_named(script)}: --help changed files"


def numbers_of_readme(run: Path) -> Iterator[str]:
    """The README's T500 and spread are, rounded, those of a run and of the reference."""
    found = README_NUMBERS.search((ROOT / "README.md").read_text(encoding="utf-8"))
    if found is None:
        yield "README.md: the sentence with T500 and the spread is not there any more; mend docs/check.py"
        return
    summary = json.loads((run / "summary.json").read_text(encoding="utf-8"))
    time, spread = reference()
    first = next(i for i, d in enumerate(spread) if d >= 0.5)
    part = (0.5 - spread[first - 1]) / (spread[first] - spread[first - 1])
    t500 = time[first - 1] + part * (time[first] - time[first - 1])
    said = zip(found.groups(), (summary["t500"], summary["final_spread"], t500, spread[-1]), strict=True)
    for text, value in said:
        digits = len(text.partition(".")[2])
        if not abs(float(text) - value) <= ROUNDED * 10**-digits:
            yield f"README.md: says {text}, and it is {value:.{digits + 1}f}"


def reference() -> tuple[list[float], list[float]]:
    with REFERENCE.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return [float(row["time_s"]) for row in rows], [float(row["spread_diameter_m"]) for row in rows]


def _without_code(text: str) -> str:
    return re.sub(r"^```.*?^```|`[^`\n]*`", "", text, flags=re.MULTILINE | re.DOTALL)


def _docstring(script: Path) -> str:
    return ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or ""


def _named(path: Path) -> str:
    return path.relative_to(ROOT).as_posix() if path.is_relative_to(ROOT) else str(path)


def _state() -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in tracked()}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--scripts", action="store_true", help="ask every script of the docs and benchmarks for its help"
    )
    parser.add_argument("--run", type=Path, metavar="DIR", help="run directory of cases/slump.json")
    chosen = parser.parse_args()
    wrong = [*merge_marks(), *dead_links(), *files_that_are_not_there(), *figures_without_a_source()]
    wrong += [*cases_that_the_gallery_lacks(), *names_that_do_not_exist(), *riddles()]
    if chosen.scripts:
        wrong += scripts_without_help()
    if chosen.run is not None:
        wrong += numbers_of_readme(chosen.run)
    print("\n".join(wrong) or "the docs are whole")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
