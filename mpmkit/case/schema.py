"""JSON Schema of case files, for completion in an editor."""

from __future__ import annotations

from typing import Any

from ..registry import Registry
from ..registry.blame import blaming_plugins
from .composed import case_model
from .parameters import BLOCK, SCHEMA


def case_schema(registry: Registry) -> dict[str, Any]:
    """The schema, with the unit of every quantity and the parameters of every registered plug-in."""
    with blaming_plugins(registry.all()):
        schema = case_model(registry).model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "mpmkit case"
    schema["properties"]["$schema"] = {"type": "string", "description": "where an editor finds this schema"}
    _allow_formulas(schema["properties"])
    _allow_formulas(schema["$defs"])
    schema["properties"][BLOCK] = SCHEMA
    return schema


FORMULA = {"type": "string", "pattern": "^\\s*=", "description": "a formula of the parameters"}


def _allow_formulas(node: Any) -> None:
    """Allow a formula wherever a number is allowed."""
    if isinstance(node, list):
        for part in node:
            _allow_formulas(part)
    if not isinstance(node, dict):
        return
    for part in node.values():
        _allow_formulas(part)
    if node.get("type") == "number":
        bounds = {key: node.pop(key) for key in list(node) if key not in ABOUT}
        node["anyOf"] = [bounds, FORMULA]


ABOUT = ("title", "description", "default", "unit", "examples")
"""Keys of a schema that describe a value, and do not restrict it."""
