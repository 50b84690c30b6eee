"""``--set path.to.key=value``: change one value of a case before it is validated."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterable
from typing import Any

from ..contracts import KINDS, Plugin
from ..errors import CaseError
from .allowed import shown
from .strict_json import decode

DEEPEST = 20
"""Most keys in a path: far more than the levels of any case."""


def apply_overrides(data: dict[str, Any], overrides: Iterable[str]) -> dict[str, Any]:
    """A copy of ``data`` with every override applied; the value is JSON, or text if it is not valid JSON.

    A part of the path that is a number is an index into a list. A plug-in that is named by a string
    turns into an object when one of its parameters is set: ``scheme.shape.domain=stretch``.

    Raises:
        CaseError: an override cannot be read, or its path leads nowhere.
    """
    data = copy.deepcopy(data)
    for override in overrides:
        path, sign, text = override.partition("=")
        try:
            if not sign or not _is_path(path):
                raise ValueError("it must read path.to.key=value, such as scheme.order=usf")
            assign(data, path, _value(text))
        except ValueError as error:
            given = override if len(override) <= 60 else override[:57] + "..."
            raise CaseError(f"--set {given}: {error}") from None
    return data


def _value(text: str) -> Any:
    try:
        return decode(text)
    except json.JSONDecodeError:
        return text


def _is_path(path: str) -> bool:
    keys = path.split(".")
    return all(keys) and len(keys) <= DEEPEST


def assign(data: dict[str, Any], path: str, value: Any) -> None:
    """Set the value at a path of ``data``, as ``apply_overrides`` does.

    Raises:
        ValueError: the path leads nowhere.
    """
    if not _is_path(path):
        raise ValueError(f"'{path}' is not a path; it must read path.to.key, such as scheme.order")
    keys = path.split(".")
    here: Any = data
    for depth, key in enumerate(keys):
        index = _index(here, key, ".".join(keys[:depth]))
        if depth == len(keys) - 1:
            here[index] = _in_its_entry(here, index, keys, value)
            return
        below = here[index] if isinstance(here, list) else here.get(index)
        if below is None:
            below = here[index] = {}
        elif isinstance(below, str) and (named_by := _plugin_key(keys[: depth + 1])) is not None:
            below = here[index] = {named_by: below}
        here = below


def _in_its_entry(here: Any, index: Any, keys: list[str], value: Any) -> Any:
    """A parameter with a new value if only a value is given; else the value itself."""
    entry = here.get(index) if isinstance(here, dict) else None
    if keys[0] == "parameters" and len(keys) == 2 and isinstance(entry, dict) and not isinstance(value, dict):
        return entry | {"value": value}
    return value


def _plugin_key(path: list[str]) -> str | None:
    """Key at which the object at a path names its plug-in; None if there is no plug-in."""
    if len(path) == 3 and path[0] == "walls":
        return KINDS[path[2]][1].named_by if path[2] in KINDS else None
    if (len(path) == 2 and path[0] == "scheme") or path[-1] == "equation_of_state":
        return Plugin.named_by
    return None


def _index(here: Any, key: str, path: str) -> Any:
    """The key, or the index of a list."""
    if isinstance(here, dict):
        return key
    if not isinstance(here, list):
        raise ValueError(f"{path} is {shown(here)}, so that it has no '{key}' in it")
    if not here:
        raise ValueError(f"{path} is an empty list, so that it has no '{key}' in it")
    if not (key.isascii() and key.isdigit() and int(key) < len(here)):
        allowed = "0" if len(here) == 1 else f"a number from 0 to {len(here) - 1}"
        raise ValueError(f"{path} is a list of {len(here)}, so that '{key}' must be {allowed}")
    return int(key)
