"""Run every command and every code block of pages, in the order of each page, in a folder of its own.

    python docs/run_blocks.py README.md docs/tutorial.md docs/howto/*.md

Continuous integration calls it with all of them, which takes two minutes. A comment before a block says what
is special about it:

    <!-- not run: REASON -->      it is printed, and not run
    <!-- with: --until 0.01 -->   these options are added to every mpmkit command of the block
    <!-- fails with 2: TEXT -->   the exit status, and what the error must say
    <!-- prints: TEXT -->         what the standard output must hold

A block of JSON after "as `NAME`:" is saved under that name. Any other one must be a valid case, or JSON.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[1]
FENCE = re.compile(r"^(`{3,})(\w*)\s*$")
NOTE = re.compile(r"^<!-- (not run|with|fails with \d+|prints): (.*) -->$")
SAVED = re.compile(r"as `([\w.-]+)`:\s*$")
COMMANDS = ("", "bash", "sh", "console")
LONGEST = 600
"""Seconds of one block."""


@dataclass
class Block:
    """A block of code of a page, and what the page says about it."""

    page: Path
    line: int
    language: str
    text: str
    saved_as: str | None = None
    notes: dict[str, str] = field(default_factory=dict)

    @property
    def place(self) -> str:
        """Where the block begins."""
        page = self.page.relative_to(ROOT) if self.page.is_relative_to(ROOT) else self.page
        return f"{page}:{self.line}"


def blocks(page: Path) -> Iterator[Block]:
    """The fenced blocks of a page, and the indented ones, which hold commands."""
    lines = page.read_text(encoding="utf-8").splitlines()
    notes: dict[str, str] = {}
    said = ""
    number = 0
    while number < len(lines):
        line = lines[number]
        first = number + 1
        fence, note = FENCE.match(line), NOTE.match(line)
        if fence or (line.startswith("    ") and not lines[number - 1].strip()):
            body = []
            number += 1 if fence else 0
            while number < len(lines) and not (fence and lines[number].startswith(fence[1])):
                if not fence and lines[number].strip() and not lines[number].startswith("    "):
                    break
                body.append(lines[number] if fence else lines[number][4:])
                number += 1
            number += 1 if fence else 0
            saved = SAVED.search(said)
            text = "\n".join(body).strip("\n") + "\n"
            yield Block(page, first, fence[2] if fence else "", text, saved and saved[1], notes)
            notes, said = {}, ""
            continue
        if note:
            notes[note[1]] = note[2]
        elif line.strip():
            said = line
        number += 1


def run(block: Block, folder: Path) -> str | None:
    """Run a block in a folder; what is wrong with it, or None."""
    if "not run" in block.notes:
        return None
    if block.saved_as:
        (folder / block.saved_as).write_text(block.text, encoding="utf-8")
    if block.language == "json":
        return _json_problem(block.text)
    if block.language == "toml":
        tomllib.loads(block.text)
        return None
    if block.language == "python":
        script = folder / f"block_{block.line}.py"
        script.write_text(block.text, encoding="utf-8")
        return _problem([sys.executable, script.name], block, folder)
    if block.language in COMMANDS:
        for command in block.text.replace("\\\n", " ").splitlines():
            if command.strip() and (problem := _problem(_shell(command, block), block, folder)):
                return f"{command.strip()}: {problem}"
    return None


def _shell(command: str, block: Block) -> list[str]:
    """A command as bash runs it, without what installs, with the options that the page adds."""
    command = re.sub(r"^\s*pip install \S+( '[^']*')? && ", "", command.partition("   #")[0])
    if (options := block.notes.get("with")) and re.match("mpmkit (run|plan|compare)", command):
        command = f"{command} {options}"
    return ["bash", "-ec", command]


def _problem(command: list[str], block: Block, folder: Path) -> str | None:
    paths = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    ended = subprocess.run(
        command,
        cwd=folder,
        env=os.environ | {"PATH": paths, "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        check=False,
        timeout=LONGEST,
    )
    expected = next((note for note in block.notes if note.startswith("fails")), "fails with 0")
    if ended.returncode != int(expected.split()[-1]):
        return f"ends with status {ended.returncode}: {ended.stderr[-500:]}"
    said = ((block.notes.get(expected, ""), ended.stderr), (block.notes.get("prints", ""), ended.stdout))
    for text, stream in said:
        if text not in stream:
            return f"does not say '{text}', but: {stream[-500:]}"
    return None


def _json_problem(text: str) -> str | None:
    from mpmkit.case import parse_case
    from mpmkit.errors import CaseError

    try:
        data = json.loads(text if text.lstrip().startswith(("{", "[")) else f"{{{text}}}")
        if "space" in data:
            parse_case(data)
    except (ValueError, CaseError) as error:
        return str(error)
    return None


def failures(page: Path) -> Iterator[str]:
    """Run the blocks of a page; a sentence for each that does not do what the page says."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(ROOT / "cases", folder / "cases")
        for block in blocks(page):
            reason = block.notes.get("not run")
            what = f"not run: {reason}" if reason else block.language or "commands"
            print(f"{block.place}: {what}", flush=True)
            if problem := run(block, folder):
                yield f"{block.place}: {problem}"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("pages", nargs="+", type=Path)
    wrong = [failure for page in parser.parse_args().pages for failure in failures(page.resolve())]
    print("\n".join(wrong) or "every block does what its page says")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
