"""Docstrings are plain text with ``code`` in it; Sphinx reads them as reStructuredText."""

from __future__ import annotations

import re
from typing import Any

CODE = re.compile(r"(``.+?``)")
MARKUP = re.compile(r"([*|_`\\])")


def readable(_app: Any, _what: str, _name: str, _thing: Any, _options: Any, lines: list[str]) -> None:
    """Escape what reStructuredText would take for markup; an indented equation stays as it is written."""
    for number, line in enumerate(lines):
        if line.lstrip().startswith((":", "..")):  # of napoleon
            head, colon, rest = line.partition(": ")
            lines[number] = head + colon + _escaped(rest)
        else:
            lines[number] = _escaped(line)


def _escaped(line: str) -> str:
    parts = CODE.split(line)
    return "".join(part if CODE.fullmatch(part) else MARKUP.sub(r"\\\1", part) for part in parts)
