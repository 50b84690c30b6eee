"""``--set path.to.key=value``: change one value of a case before it is validated."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterable
from typing import Any

from ..errors import CaseError


def apply_overrides(data: dict[str, Any], overrides: Iterable[str]) -> dict[str, Any]:
    """A copy of ``data`` with every override applied; the value is JSON, or else taken as text.

    A part of the path that is a number is an index into a list. A plug-in that is named by a string
    turns into an object when one of its parameters is set: ``scheme.shape.domain=stretch``.
    """
    data = copy.deepcopy(data)
    for override in overrides:
        path, sign, text = override.partition("=")
        if not sign or not path.strip("."):
            raise CaseError(f"--set {override}: it must read path.to.key=value, such as scheme.order=usf")
        _assign(data, path.split("."), _value(text), override)
    return data


def _value(text: str) -> Any:
    try:
        return json.loads(text, parse_constant=lambda name: _refuse(name))
    except json.JSONDecodeError:
        return text


def _refuse(name: str) -> Any:
    raise CaseError(f"--set: {name} is not a number that a case can have; every number must be finite")


def _assign(data: dict[str, Any], keys: list[str], value: Any, override: str) -> None:
    here: Any = data
    for depth, key in enumerate(keys):
        last = depth == len(keys) - 1
        if isinstance(here, list):
            if not key.isdigit() or int(key) >= len(here):
                raise CaseError(
                    f"--set {override}: '{'.'.join(keys[:depth])}' is a list of {len(here)}, so '{key}' must be "
                    f"a number from 0 to {len(here) - 1}"
                )
            index: Any = int(key)
        elif isinstance(here, dict):
            index = key
        else:
            raise CaseError(f"--set {override}: '{'.'.join(keys[:depth])}' is {here!r} and has no '{key}' in it")
        if last:
            here[index] = value
            return
        below = here[index] if isinstance(here, list) else here.get(index)
        if below is None:
            below = here[index] = {}
        elif isinstance(below, str) and keys[:1] == ["scheme"]:
            below = here[index] = {"name": below}
        here = below
