"""Names on the pages that must exist: commands and options of mpmkit, and keys of a case.

``docs/check.py`` calls ``dead_names`` for every page.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
SCHEMA = ROOT / "docs/schema/case.schema.json"
COMMAND = re.compile(r"\bmpmkit ([a-z][a-z-]*)((?:[ =][^\s`|;#&]+)*)")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
CODE = re.compile(r"`([^`\n]+)`")
KEY = re.compile(
    r"(?:scheme|grid|output|until|bodies|walls|sources|sinks|forces|parameters|measurements)(?:\.[\w…*<>-]+)+"
)
ANY = re.compile(r"…|\*|<\w+>|[A-Z]+|i|n|\d+")
"""A part of a key that stands for an index or a name."""
PARTS = ("anyOf", "oneOf", "allOf")


def dead_names(text: str) -> Iterator[str]:
    """Sentences on the names of a page, Markdown, that do not exist."""
    for name, rest in COMMAND.findall(text):
        if name not in commands():
            if OPTION.search(rest):  # otherwise it may be a sentence that begins with the name of the program
                yield f"there is no command 'mpmkit {name}'"
            continue
        for option in OPTION.findall(rest):
            if option not in commands()[name]:
                yield f"'mpmkit {name}' has no option {option}"
    for code in CODE.findall(text):
        if KEY.fullmatch(code) and not is_key(code):
            yield f"a case has no key '{code}'"
        if OPTION.fullmatch(code.partition(" ")[0].partition("=")[0]):
            option = code.partition(" ")[0].partition("=")[0]
            if option not in options_of_scripts() and not any(option in of for of in commands().values()):
                yield f"there is no option {option}"


@cache
def commands() -> dict[str, set[str]]:
    """The options of each command of mpmkit, with those of all commands."""
    from mpmkit.cli.commands import commands as group

    common = {"--help", *(name for parameter in group.params for name in parameter.opts)}
    return {
        name: common | {option for parameter in command.params for option in parameter.opts}
        for name, command in group.commands.items()
    }


@cache
def options_of_scripts() -> set[str]:
    """Options of the scripts of this repository and of the programs that they call."""
    files = [*ROOT.glob("docs/**/*.py"), *ROOT.glob("benchmarks/**/*.py"), ROOT / ".ci/run"]
    return {option for file in files for option in OPTION.findall(file.read_text(encoding="utf-8"))}


def is_key(path: str) -> bool:
    """Whether a case can have a key ``scheme.time_step.fraction``; ``…`` and ``*`` stand for any name."""
    whole = _schema()
    found = [whole]
    for part in path.split("."):
        found = [below for node in found for below in _below(node, part, whole)]
    return bool(found)


@cache
def _schema() -> dict[str, Any]:
    return json.loads(SCHEMA.read_text(encoding="utf-8"))


def _below(node: Any, part: str, whole: dict[str, Any]) -> Iterator[Any]:
    """The schemas of an entry of a value."""
    if not isinstance(node, dict):
        return
    if "$ref" in node:
        target = whole
        for step in node["$ref"].removeprefix("#/").split("/"):
            target = target[step]
        yield from _below(target, part, whole)
    for several in PARTS:
        for one in node.get(several, []):
            yield from _below(one, part, whole)
    if part in node.get("properties", {}):
        yield node["properties"][part]
    elif isinstance(node.get("additionalProperties"), dict):
        yield node["additionalProperties"]
    elif ANY.fullmatch(part):
        yield from node.get("properties", {}).values()
    if ANY.fullmatch(part) and "items" in node:
        yield node["items"]
