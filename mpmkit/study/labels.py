"""Names of members in figures and messages: the name of each dimension, and units."""

from __future__ import annotations

import math
from typing import Any

import xarray
from pydantic import BaseModel

from ..case.model import Case
from .members import MEMBER


def unit_of(case: Case, path: str) -> str | None:
    """Unit of the quantity at a path of a case; None if it has none."""
    node: Any = case
    unit = None
    for key in path.split("."):
        if isinstance(node, BaseModel):
            field = type(node).model_fields.get(key)
            extra = None if field is None else field.json_schema_extra
            unit = extra.get("unit") if isinstance(extra, dict) else None
            node = getattr(node, key, None)
        elif isinstance(node, dict):
            node = node.get(key)
        elif isinstance(node, list) and key.isdigit() and int(key) < len(node):
            node = node[int(key)]
        else:
            return None
    return None if unit is None else str(unit)


def short_names(paths: list[str]) -> dict[str, str]:
    """The last part of each path in words, with as many parts before it as needed to make it unique."""
    found = {}
    for path in paths:
        parts = path.split(".")
        count = 1
        while count < len(parts) and any(
            other != path and other.split(".")[-count:] == parts[-count:] for other in paths
        ):
            count += 1
        found[path] = " ".join(parts[-count:]).replace("_", " ")
    return found


def title_of(member: xarray.Dataset, dimensions: tuple[str, ...]) -> str:
    """A member as a legend names it, such as ``yield stress 300 Pa, order usl``."""
    names = short_names(list(dimensions))
    return ", ".join(_labelled(names[name], member[name]) for name in dimensions)


def _labelled(name: str, label: xarray.DataArray) -> str:
    text, unit = str(label.item()), label.attrs.get("units")
    if unit is not None and unit != "1" and _is_number(text):
        text = f"{text} {unit}"
    return text if name == MEMBER else f"{name} {text}"


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False
