"""``--vary PATH=A,B``: the dimensions of a study on the command line."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from ..case.strict_json import decode
from ..errors import CaseError

OPENING, CLOSING = "[{", "]}"


def parse_vary(options: Iterable[str]) -> dict[str, list[Any]]:
    """Paths and values of ``path.to.key=a,b,c``; each value is JSON, or text if it is not valid JSON.

    Raises:
        CaseError: an option cannot be read, or a path is given twice.
    """
    vary: dict[str, list[Any]] = {}
    for option in options:
        path, sign, text = option.partition("=")
        values = [value.strip() for value in _split(text)]
        if not sign or not path or not all(values):
            raise CaseError(f"--vary {option}: it must read path.to.key=a,b, such as scheme.order=usl,usf")
        if path in vary:
            raise CaseError(f"--vary {option}: {path} is varied already; give all its values at once")
        vary[path] = [_value(value) for value in values]
    return vary


def _split(text: str) -> list[str]:
    """Split at the commas outside lists, objects and strings."""
    parts, depth, quoted = [""], 0, False
    for character in text:
        if character == '"':
            quoted = not quoted
        elif not quoted:
            depth += (character in OPENING) - (character in CLOSING)
        if character == "," and not quoted and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return parts


def _value(text: str) -> Any:
    try:
        return decode(text)
    except json.JSONDecodeError:
        return text
    except ValueError as error:
        raise CaseError(f"--vary: {text}: {error}") from None
