"""JSON Schema of case files, for completion in an editor."""

from __future__ import annotations

from typing import Any

from ..registry import Registry
from ..registry.blame import blaming_plugins
from .composed import case_model


def case_schema(registry: Registry) -> dict[str, Any]:
    """The schema, with the unit of every quantity and the parameters of every registered plug-in."""
    with blaming_plugins(registry.all()):
        schema = case_model(registry).model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "mpmkit case"
    schema["properties"]["$schema"] = {"type": "string", "description": "where an editor finds this schema"}
    return schema
