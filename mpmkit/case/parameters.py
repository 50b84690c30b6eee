"""The parameters of a case: named numbers at its top, from which other numbers are computed.

A case may begin with a block ``parameters``. Any number of the case may then be a text that begins with "=",
a formula of their names:

    "parameters": {
      "top_radius": {"value": 0.05, "unit": "m", "description": "radius of the mould at its top", "above": 0}
    },
    ...
    "shape": {"kind": "cylinder", "radius": "= top_radius", "height": "= 2 * top_radius"}

The block is removed when a case is read: runs, studies and fits only see numbers.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any, NamedTuple

from ..errors import CaseError
from .allowed import one_of, shown
from .formula import FUNCTIONS, ROUNDING, evaluate, names_in, parse, with_numbers
from .measurements import NAMES as MEASURED
from .measurements import SELF as MEASUREMENTS
from .synonyms import nearest

BLOCK = "parameters"
SIGN = "="
NAME = re.compile(r"[a-z][a-z0-9_]*")
LIMITS = {
    "above": ("above", lambda value, limit: value > limit),
    "at_least": ("at least", lambda value, limit: value >= limit - ROUNDING * abs(limit)),
    "below": ("below", lambda value, limit: value < limit),
    "at_most": ("at most", lambda value, limit: value <= limit + ROUNDING * abs(limit)),
}
KEYS = ("value", "unit", "description", *LIMITS, "fine")

NUMBER_OR_FORMULA = {"type": ["number", "string"]}
SCHEMA = {
    "type": "object",
    "description": "numbers that formulas of the case use, such as \"= 2 * radius\"; a value may be a "
    "formula of the parameters above it",
    "propertyNames": {"pattern": f"^{NAME.pattern}$"},
    "additionalProperties": {
        "type": "object",
        "required": ["value", "unit", "description"],
        "additionalProperties": False,
        "properties": {
            "value": NUMBER_OR_FORMULA,
            "unit": {"type": "string", "description": "1 for a plain number"},
            "description": {"type": "string"},
            "fine": NUMBER_OR_FORMULA | {"description": "value of the fine variant"},
            **{limit: NUMBER_OR_FORMULA | {"description": f"the value is {words} this"}
               for limit, (words, _) in LIMITS.items()},
        },
    },
}  # fmt: skip
"""JSON Schema of the block."""


class Parameter(NamedTuple):
    """A parameter for display."""

    value: float
    unit: str
    description: str
    given: bool
    """Whether it is a number in the file, and not a formula of parameters above it."""


def expand(data: dict[str, Any], source: str = "case") -> dict[str, Any]:
    """The content of a case file without the block, and with numbers where it has formulas.

    Raises:
        CaseError: the block is not valid, a parameter is beyond its limits, or a formula has
            no number.
    """
    if BLOCK not in data:
        _refuse_formulas(data, source)
        return data
    known = {name: entry.value for name, entry in parameters(data, source).items()}
    scene = {key: _computed(value, key, known, source) for key, value in data.items() if key != BLOCK}
    _fill_in(scene.get(MEASUREMENTS), known, source)
    return scene


def refuse_unused(data: dict[str, Any], source: str = "case") -> None:
    """Refuse a parameter of a case file that no formula of the file uses: to change it would change nothing.

    Raises:
        CaseError: names it.
    """
    block = data.get(BLOCK)
    if not isinstance(block, dict):
        return
    used = {name for text in _formulas(data) for name in _names_in(text)}
    for name in block:
        if name not in used:
            raise CaseError(
                f"{source}: {BLOCK}.{name} is used by no formula of the case, so that it would change "
                "nothing; leave it out"
            )


def _formulas(data: Any) -> Iterator[str]:
    """The texts of all formulas in a part of a case."""
    if isinstance(data, dict | list):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            if key == "formula" and isinstance(value, str):
                yield value
            yield from _formulas(value)
    elif _is_formula(data):
        yield data.removeprefix(SIGN)


def _names_in(text: str) -> set[str]:
    try:
        return names_in(parse(text))
    except ValueError:  # the error is reported when it is computed
        return set()


def parameters(data: dict[str, Any], source: str = "case") -> dict[str, Parameter]:
    """The parameters of the content of a case file, within their limits.

    Raises:
        CaseError: one is not valid or beyond its limits.
    """
    block = data.get(BLOCK, {})
    if not isinstance(block, dict):
        raise CaseError(f"{source}: {BLOCK} is {shown(block)}; it must be an object of parameters")
    known: dict[str, float] = {}
    found = {}
    for name, entry in block.items():
        where = f"{BLOCK}.{name}"
        _check_entry(name, entry, source)
        known[name] = _value(entry["value"], f"{where}.value", known, source)
        found[name] = Parameter(
            known[name], entry["unit"], entry["description"], not _is_formula(entry["value"])
        )
    for name, entry in block.items():  # after all are known: a limit may be a parameter further down
        _check_limits(name, entry, known, source)
    return found


def fine(data: dict[str, Any]) -> dict[str, Any]:
    """The content of a case file with the values of its fine variant."""
    block = {
        name: entry | {"value": entry["fine"]} if isinstance(entry, dict) and "fine" in entry else entry
        for name, entry in data.get(BLOCK, {}).items()
    }
    return data | {BLOCK: block} if block else data


def has_fine(data: dict[str, Any]) -> bool:
    """Whether a case file has a fine variant."""
    return any(isinstance(entry, dict) and "fine" in entry for entry in data.get(BLOCK, {}).values())


def _check_entry(name: str, entry: Any, source: str) -> None:
    where = f"{source}: {BLOCK}.{name}"
    if not NAME.fullmatch(name) or name in FUNCTIONS:
        raise CaseError(
            f"{source}: {BLOCK} has one called {shown(name)}; a name must be of lower-case letters, digits "
            f"and '_', begin with a letter, and not be that of a function ({', '.join(FUNCTIONS)})"
        )
    if name in MEASURED:
        raise CaseError(
            f"{where} has the name of a variable of the history, which formulas of measurements use; "
            "give it another"
        )
    if not isinstance(entry, dict):
        raise CaseError(
            f'{where} is {shown(entry)}; it must be an object such as {{"value": 0.1, "unit": "m", '
            '"description": "radius of the mould"}'
        )
    for key in entry:
        if key not in KEYS:
            near = nearest(key, KEYS)
            raise CaseError(
                f"{where} has an unknown key '{key}'; it may have {one_of(list(KEYS))}"
                + ("" if near is None else f"; did you mean '{near}'?")
            )
    for key in ("value", "unit", "description"):
        if key not in entry:
            raise CaseError(f"{where}.{key} is missing")
    for key in ("unit", "description"):
        if not isinstance(entry[key], str):
            raise CaseError(f"{where}.{key} is {shown(entry[key])}; it must be a text")


def _check_limits(name: str, entry: dict[str, Any], known: dict[str, float], source: str) -> None:
    unit = "" if entry["unit"] == "1" else f" {entry['unit']}"
    for key, (words, holds) in LIMITS.items():
        if key not in entry:
            continue
        limit = _value(entry[key], f"{BLOCK}.{name}.{key}", known, source)
        if not holds(known[name], limit):
            of = f", which is {entry[key].removeprefix(SIGN).strip()}" if _is_formula(entry[key]) else ""
            raise CaseError(
                f"{source}: {BLOCK}.{name} ({entry['description']}) is {known[name]:.6g}{unit}; it must be "
                f"{words} {limit:.6g}{unit}{of}"
            )


def _value(given: Any, where: str, known: dict[str, float], source: str) -> float:
    if _is_formula(given):
        return _result(given, where, known, source)
    if isinstance(given, bool) or not isinstance(given, int | float):
        raise CaseError(
            f"{source}: {where} is {shown(given)}; it must be a number, or a formula such as "
            f"{json.dumps(f'{SIGN} 2 * radius')}"
        )
    return float(given)


def _result(text: str, where: str, known: dict[str, float], source: str) -> float:
    try:
        return evaluate(parse(text.removeprefix(SIGN)), known)
    except ValueError as error:
        raise CaseError(f"{source}: {where} is {shown(text)}: {error}") from None


def _computed(value: Any, where: str, known: dict[str, float], source: str) -> Any:
    """A part of a case with numbers for its formulas."""
    if isinstance(value, dict):
        return {k: _computed(v, f"{where}.{k}", known, source) for k, v in value.items()}
    if isinstance(value, list):
        return [_computed(v, f"{where}.{k}", known, source) for k, v in enumerate(value)]
    if not _is_formula(value):
        return value
    return _result(value, where, known, source)


def _fill_in(measurements: Any, known: dict[str, float], source: str) -> None:
    """Replace parameters by numbers in the formulas of measurements, which are evaluated during the run."""
    for name, entry in measurements.items() if isinstance(measurements, dict) else ():
        if isinstance(entry, dict) and isinstance(entry.get("formula"), str):
            try:
                tree = parse(entry["formula"])
            except ValueError as error:
                raise CaseError(f"{source}: {MEASUREMENTS}.{name}.formula: {error}") from None
            entry["formula"] = with_numbers(tree, known)


def _is_formula(value: Any) -> bool:
    return isinstance(value, str) and value.lstrip().startswith(SIGN)


def _refuse_formulas(data: Any, source: str, where: str = "") -> None:
    parts = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in parts:
        place = f"{where}.{key}" if where else str(key)
        if _is_formula(value) and key not in ("description", "name"):
            raise CaseError(
                f"{source}: {place} is the formula {shown(value)}, but the case has no {BLOCK} of which "
                "it could be computed"
            )
        _refuse_formulas(value, source, place)
