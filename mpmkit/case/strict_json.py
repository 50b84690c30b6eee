"""Strict JSON for cases: no duplicate keys in an object, not too many keys, and only finite numbers."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

NESTED = "its objects and lists are nested too deeply"
MOST_DIGITS = 400
"""Longest number: more digits than any double has, and less than Python's limit, whose message is unclear."""
MOST_KEYS = 10_000
"""Most keys in one object: far more than any case or study has; each unknown key is checked."""
LONGEST_PATH = 200
"""Most characters of a place that are shown."""


@dataclass(frozen=True)
class Refused:
    """Marks a value that a case cannot have, until its place is known."""

    why: str


def decode(text: str) -> Any:
    """Parse JSON.

    Raises:
        json.JSONDecodeError: it is not JSON.
        ValueError: it is JSON, but contains a value that a case cannot have; the message names the place and
        is the end of a sentence.
    """
    try:
        data = json.loads(
            text, object_pairs_hook=_unique, parse_constant=_refuse, parse_float=_finite, parse_int=_integer
        )
    except RecursionError:
        raise ValueError(NESTED) from None
    require_finite(data)
    return data


def require_finite(data: Any) -> None:
    """Refuse, with the place, the first number that is not finite, and whatever ``decode`` refused.

    Raises:
        ValueError: see ``decode``.
    """
    for path, value in _leaves(data):
        if isinstance(value, float) and not math.isfinite(value):
            value = _refuse(str(value))
        if isinstance(value, Refused):
            place = ".".join(str(key) for key in path)[:LONGEST_PATH]
            raise ValueError(f"{place}: {value.why}" if place else value.why)


def _leaves(data: Any) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    """Places and values of all that is neither an object nor a list, in the order of the text.

    An object with too many keys counts as refused.
    """
    pending: list[tuple[tuple[str | int, ...], Any]] = [((), data)]
    while pending:  # no recursion: the depth of the text is checked elsewhere
        path, value = pending.pop()
        if isinstance(value, dict) and len(value) > MOST_KEYS:
            first = str(next(iter(value)))[:LONGEST_PATH]
            why = (
                f"an object has {len(value):,} keys, of which '{first}' is the first; "
                f"at most {MOST_KEYS:,} are read"
            )
            yield path, Refused(why)
        elif isinstance(value, dict):
            pending += [((*path, key), item) for key, item in reversed(value.items())]
        elif isinstance(value, list | tuple):
            pending += [((*path, index), item) for index, item in reversed(list(enumerate(value)))]
        else:
            yield path, value


def _unique(pairs: list[tuple[str, Any]]) -> Any:
    found = dict(pairs)
    if len(found) < len(pairs):
        seen: set[str] = set()
        twice = next(key for key, _ in pairs if key in seen or seen.add(key))  # type: ignore[func-returns-value]
        return Refused(f"the key '{twice}' appears twice in one object; keep one of them")
    return found


def _refuse(number: str) -> Any:
    return Refused(f"{number} is not a number that a case can have; every number must be finite")


def _finite(digits: str) -> Any:
    value = float(digits)
    return value if math.isfinite(value) else _refuse(digits[:20])


def _integer(digits: str) -> Any:
    if len(digits) > MOST_DIGITS:
        return Refused(
            f"{digits[:20]}… has {len(digits)} digits; a number of a case has at most {MOST_DIGITS}"
        )
    return int(digits)
