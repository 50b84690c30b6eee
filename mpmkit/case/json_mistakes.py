"""Why a text is not valid JSON, in words for people who write it by hand.

Python's reader says where it stopped, and "Expecting property name enclosed in double quotes" for nearly all.
"""

from __future__ import annotations

import json
import re

LITERALS = {"True": "true", "False": "false", "None": "null", "NULL": "null", "Null": "null"}
LITERALS |= {"TRUE": "true", "FALSE": "false", "yes": "true", "no": "false", "on": "true", "off": "false"}
WORD = re.compile(r"[^\W\d][\w.+-]*")
NEEDED = (
    "and JSON is needed: convert the file, or write braces around all, every name and text in double quotes, "
    "and a comma between two entries"
)
LONGEST = 40
"""Most characters of the text that are shown."""


def mistake(text: str, error: json.JSONDecodeError) -> str:
    """What is wrong with a text that Python's reader has refused, with its line and column."""
    at, why = _found(text, error.pos, error.msg)
    line = text.count("\n", 0, at) + 1
    column = at - (text.rfind("\n", 0, at) + 1) + 1
    return f"at line {line}, column {column}, {why}"


def _found(text: str, at: int, said: str) -> tuple[int, str]:
    """Place and sentence."""
    begin = len(text) - len(text.lstrip())
    if text[begin] not in "{\"'/":
        if re.match(r"(---|%YAML.*\n|#.*\n|\s)*(- |[\w$-]+\s*:)", text) and "{" not in text[: at + 1]:
            return begin, f"YAML begins, {NEEDED}"
        if re.match(r"(#.*\n|\s)*(\[[\w.]+\]|[\w.-]+\s*=)", text):
            return begin, f"TOML begins, {NEEDED}"
    here = _skip_blank(text, at)
    rest = text[here : here + 200]
    before = text[:here].rstrip()
    if rest.startswith(("//", "/*", "#")):
        return (
            here,
            'a comment begins, and JSON has none; delete it, or write it as the "description" of the case',
        )
    if rest == "":
        return len(text.rstrip()), _unfinished(text)
    if before.endswith(",") and rest[0] in "}]":
        return len(before) - 1, f"there is a comma too many: nothing follows it but '{rest[0]}'"
    if rest[0] == "," and text[here + 1 :].lstrip()[:1] in ("}", "]"):  # where Python 3.13 points
        return here, f"there is a comma too many: nothing follows it but '{text[here + 1 :].lstrip()[0]}'"
    if rest[0] == "," and before[-1:] in ("{", "[", ",", ":"):
        return here, "there is a comma too many"
    decimal = re.search(r"(?<![\w.+-])(-?\d+),\s?$", text[:here])
    digits = re.match(r"\d+(e[+-]?\d+)?", rest)
    if decimal is not None and digits is not None:
        number = f"{decimal[1]}.{digits[0]}"
        return decimal.start(), f"the decimal sign must be a point and not a comma: {number}"
    if rest[0] in "'‘’“”„«»`":
        quotes = "single quotes" if rest[0] == "'" else f"the quotes {rest[0]}"
        return here, f'a name or text stands in {quotes}; JSON has double quotes: "…"'
    misshapen = re.match(r"[+-]?[\d.][\w.]*", rest)
    if misshapen is not None and said.startswith("Expecting value"):
        return here, f"{misshapen[0][:LONGEST]} is not a JSON number; write it as 0.5, 12 or 1e-3"
    attached = re.search(r"[\d.]+$", text[:here])
    if attached is not None and re.match(r"[\d.\w]", rest) and "delimiter" in said:
        whole = attached[0] + re.match(r"[\d.\w+-]*", rest)[0]  # type: ignore[index]
        return attached.start(), f"{whole[:LONGEST]} is not a JSON number; write it as 0.5, 12 or 1e-3"
    word = WORD.match(rest)
    if word is not None and re.search(r"\d\s*$", before) and "delimiter" in said:
        return (
            here,
            f"'{word[0][:LONGEST]}' follows a number; all numbers are in SI units, do not write the unit",
        )
    if word is not None and said.startswith(("Expecting", "Illegal")):
        return here, _of_word(
            word[0], "property name" in said or text[here + len(word[0]) :].lstrip()[:1] == ":"
        )
    if re.match(r"[-+*/%^]", rest) and re.search(r"\d\s*$", before) and "delimiter" in said:
        return here, f"'{rest[0]}' follows a number; JSON does not calculate: write the result"
    if "',' delimiter" in said:
        return len(before), f"a comma or a closing bracket is missing before {_shown(rest)}"
    if "':' delimiter" in said:
        return len(before), f"a colon is missing before {_shown(rest)}"
    if said.startswith("Invalid control character"):
        return at, "a text must end on the line on which it begins; a double quote may be missing"
    if said.startswith("Invalid \\"):
        return at, "a backslash in a text must be written twice; in a path you may use a slash"
    if said.startswith("Unterminated string"):
        return at, "a text has no double quote at its end"
    if said.startswith("Extra data"):
        return here, f"the object has ended, but there is more: {_shown(rest)}"
    if "property name" in said:
        return here, f"a name in double quotes must stand where {_shown(rest)} stands"
    return here, f"a value must stand where {_shown(rest)} stands"


def _of_word(word: str, name: bool) -> str:
    shown = word[:LONGEST]
    if name:
        return f'the name {shown} must stand in double quotes: "{shown}"'
    if word in LITERALS:
        return f"{shown} must be written as {LITERALS[word]}"
    return f'the text {shown} must stand in double quotes: "{shown}"'


def _unfinished(text: str) -> str:
    """The sentence about a text that ends too early."""
    plain = re.sub(r'"(?:\\.|[^"\\])*"', '""', text)
    missing = [f"{n} '{b}'" for a, b in ("{}", "[]") if (n := plain.count(a) - plain.count(b)) > 0]
    return f"the file ends too early: {' and '.join(missing) or 'something'} must still come"


def _skip_blank(text: str, at: int) -> int:
    return at + len(text[at:]) - len(text[at:].lstrip())


def _shown(rest: str) -> str:
    return f"'{rest.split(chr(10))[0][:LONGEST].strip()}'"
