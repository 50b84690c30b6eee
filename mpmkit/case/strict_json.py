"""JSON as a case needs it: no key twice in an object, and every number finite."""

from __future__ import annotations

import json
import math
from typing import Any

NESTED = "its objects and lists are nested too deeply"
MOST_DIGITS = 400
"""Longest number: more digits than any double has; Python's own limit would be told of in Python's words."""


def decode(text: str) -> Any:
    """Parse JSON.

    Raises:
        json.JSONDecodeError: it is not JSON.
        ValueError: it is, and says something that a case cannot; the text is the end of a sentence.
    """
    try:
        return json.loads(
            text, object_pairs_hook=_unique, parse_constant=_refuse, parse_float=_finite, parse_int=_integer
        )
    except RecursionError:
        raise ValueError(NESTED) from None


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    seen: dict[str, Any] = {}
    for key, value in pairs:
        if key in seen:
            raise ValueError(f"the key '{key}' stands twice in one object; keep one of them")
        seen[key] = value
    return seen


def _refuse(number: str) -> Any:
    raise ValueError(f"{number} is not a number that a case can have; every number must be finite")


def _finite(digits: str) -> float:
    value = float(digits)
    return value if math.isfinite(value) else _refuse(digits[:20])


def _integer(digits: str) -> int:
    if len(digits) > MOST_DIGITS:
        raise ValueError(
            f"{digits[:20]}… has {len(digits)} digits; a number of a case has at most {MOST_DIGITS}"
        )
    return int(digits)
