"""Pydantic's errors as one clear sentence: the field, the value, and what is allowed.

Pydantic only gives the place of an error. The allowed values come from the JSON Schema of the case, so that
parameters of third-party plug-ins are explained like the case's own, and no wording of pydantic is shown.
"""

from __future__ import annotations

import json
import math
from functools import lru_cache
from typing import Any, NamedTuple, get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import core_schema

from ..contracts import KINDS
from ..registry import Registry
from .allowed import LONGEST, Place, one_of, shown
from .strict_json import NESTED
from .synonyms import meant, nearest

PYDANTICS_OWN = set(get_args(core_schema.ErrorType)) - {"value_error", "assertion_error"}
"""Kinds of errors with a text of pydantic; the others contain the sentence of a validator."""
TAG_ERRORS = ("union_tag_invalid", "union_tag_not_found")

MOST_EXAMINED = 100
"""Most unknown keys that are compared with the missing ones."""

MEASURED = {"diagnostics": "diagnostic", "fields": "particle_field"}
"""Kinds of the plug-ins of ``output``, by their keys."""

BY_NAME: dict[str | int, str] = {"forces": "body_force", "sinks": "sink", "sources": "source"}
"""Kinds of the plug-ins that a case has by names, by the key of the case."""

Path = tuple[str | int, ...]


class Complaint(NamedTuple):
    """One error of pydantic, at its place in the case."""

    path: Path
    kind: str
    value: Any
    text: str


def explain(
    error: ValidationError, data: Any, model: type[BaseModel], registry: Registry, what: str = "case"
) -> str:
    """The first error as a sentence, and the number of further errors; ``what`` says what ``data`` is."""
    schema = _schema(model)
    complaints = _distinct([_complaint(item, data) for item in error.errors(include_url=False)])
    unknown = [complaint for complaint in complaints if complaint.kind == "extra_forbidden"]
    # A misspelt key is also missing under its right name: one message is enough.
    true_names = {
        (*c.path[:-1], nearest(c.path[-1], Place(schema, data, c.path[:-1]).keys()))
        for c in unknown[:MOST_EXAMINED]
    }
    others = [
        c
        for c in complaints
        if c.kind != "extra_forbidden" and not (c.kind == "missing" and c.path in true_names)
    ]
    first, *rest = unknown + others
    more = f" (and {len(rest)} more)" if rest else ""
    return " ".join((_sentence(first, data, schema, registry, what) + more).split())


@lru_cache(maxsize=4)
def _schema(model: type[BaseModel]) -> dict:
    return model.model_json_schema()


def _complaint(item: Any, data: Any) -> Complaint:
    """The error, with the tags that pydantic adds for members of unions removed from its location.

    There are no tags at the top level: a missing first key belongs to a part that has its default value.
    """
    loc, kind = item["loc"], item["type"]
    keys: list[str | int] = []
    here = data
    for depth, key in enumerate(loc[:-1] if kind == "missing" else loc):
        if (isinstance(here, dict) and key in here) or (
            isinstance(here, list) and isinstance(key, int) and key < len(here)
        ):
            keys.append(key)
            here = here[key]
        elif depth == 0:
            keys.append(key)
            here = None
    if kind == "missing":
        keys.append(loc[-1])
    text = str(item["ctx"]["error"]) if "error" in item.get("ctx", {}) else item["msg"]
    return Complaint(tuple(keys), kind, here, text)


def _distinct(complaints: list[Complaint]) -> list[Complaint]:
    """One error per place; if a value fits no alternative, the error of the closest alternative."""
    first: dict[Path, Complaint] = {}
    for complaint in complaints:
        first.setdefault(complaint.path, complaint)
    inner = {path[:depth] for path in first for depth in range(len(path))}
    return [c for path, c in first.items() if path not in inner or c.kind not in PYDANTICS_OWN]


def _sentence(complaint: Complaint, data: Any, schema: dict, registry: Registry, what: str) -> str:
    path, kind, value, text = complaint
    if kind == "json_invalid":  # valid for Python's reader, but not for pydantic's
        return NESTED if "recursion" in text else f"it is not valid JSON: {text}"
    if kind == "extra_forbidden":
        return _unknown_key(path, Place(schema, data, path[:-1]).keys(), what)
    if kind not in PYDANTICS_OWN:
        return f"{_field(path)}: {text}" if path else text
    if kind == "finite_number":
        return f"{_field(path)} is {shown(value)}; it must be finite"
    place = Place(schema, data, path)
    choices, missing, selector = place.choices(), kind == "missing", place.selector()
    if kind in TAG_ERRORS and isinstance(value, dict) and selector is not None:
        key, choices = selector
        path, missing, value = (*path, key), key not in value, value.get(key)
        allowed = one_of(choices)
    else:
        allowed = one_of(choices) if choices and isinstance(value, str) else place.describe()
    unusable, why_not = _unusable(path, value, choices, registry)
    hint = "" if missing or value in unusable else _hint(value, place, [*choices, *unusable])
    state = "is missing" if missing else f"is {shown(value)}"
    return f"{_field(path)} {state}; it must be {allowed}{hint}{why_not}"


def _hint(value: Any, place: Place, choices: list[Any]) -> str:
    """Suggestions for a wrong value: one of the choices, an object named by a word, or a number."""
    if not isinstance(value, str):
        return ""
    selector = place.selector()
    names = meant(value, dict.fromkeys([*choices, *(selector[1] if selector is not None else [])]))
    meanings = [json.dumps(n) if n in choices else str(place.written_out(n)) for n in names]
    if not meanings and place.takes_numbers():
        meanings = [number] if (number := _number(value)) is not None else []
    return f"; did you mean {' or '.join(meanings)}?" if meanings else ""


def _number(text: str) -> str | None:
    """The number in a text, with a decimal point or comma, as written in a file."""
    digits = text.strip().replace(",", ".")
    try:
        return json.dumps(json.loads(digits)) if math.isfinite(float(digits)) else None
    except ValueError:
        return None


def _field(path: Path) -> str:
    return ".".join(str(key) for key in path)


def _unknown_key(path: Path, allowed: list[str], what: str) -> str:
    near = nearest(path[-1], allowed)
    hint = f"it may have {', '.join(allowed)}" if near is None else f"did you mean '{near}'?"
    return f"{_field(path[:-1]) or f'the {what}'} has an unknown key '{str(path[-1])[:LONGEST]}'; {hint}"


def _unusable(path: Path, name: Any, choices: list[Any], registry: Registry) -> tuple[list[str], str]:
    """Suggested plug-ins that cannot be used, and the reason for the most likely one.

    The sentence names similar plug-ins that were not loaded, or else all that were not loaded.
    """
    below = path[2:] if path[0] == "walls" else path  # the name of a wall may equal that of a kind
    anywhere = path[0] in ("scheme", "walls")
    kinds = [key for key in below if key in KINDS and (anywhere or key in ("law", "equation_of_state"))]
    if path[0] == "bodies" and path[2:3] == ("initial",):
        kinds = ["initial_field"]
    if "shape" in path[2:] and path[0] in ("bodies", "walls"):
        kinds = ["body_shape"]
    if path[0] in BY_NAME and not kinds:  # a source has a law as well
        kinds = [BY_NAME[path[0]]]
    if path[0] == "output":
        kinds = [MEASURED[key] for key in path[1:2] if key in MEASURED]
    if not kinds or not registry.problems:
        return [], ""
    kind, reasons = str(kinds[0]), []
    unusable = registry.unusable(kind)
    if isinstance(name, str):
        if own := registry.why_not(kind, name):
            return [name], _each(own)
        near = next(iter(meant(name, [*choices, *unusable])), None)
        reasons = registry.why_not(kind, near) if near in unusable else []
    if reasons:
        return unusable, _each(reasons)
    names = ", ".join(f"'{p.entry_point}' of '{p.distribution}'" for p in registry.problems)
    return unusable, f"; plug-ins that were not loaded are {names}, see mpmkit plugins"


def _each(reasons: list[str]) -> str:
    return "".join(f"; {reason}" for reason in reasons)
