"""Every key of a case file with unit, default and what is allowed, from the schema of the pydantic model."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

WORDS = {"number": "number", "integer": "whole number", "string": "text", "boolean": "`true` or `false`"}
"""For the types of JSON Schema."""
CHOSEN_BY = ("law", "kind", "name")
"""Keys that say which of several models an object is."""


def page() -> str:
    """A section for each place in a case file at which an object stands."""
    from mpmkit.case import case_schema
    from mpmkit.case.schema import FORMULA
    from mpmkit.registry import installed

    return "\n".join(Reference(case_schema(installed()), FORMULA).sections())


class Reference:
    """The schema, as tables.

    Args:
        schema: of case files.
        anywhere: what may stand at the place of any number, and is not said at each.
    """

    def __init__(self, schema: dict[str, Any], anywhere: dict[str, Any]) -> None:
        self._schema, self._anywhere = schema, anywhere
        self._places: dict[str, str] = {}

    def sections(self, place: str = "", node: Any = None) -> Iterator[str]:
        """A section for a place, then for the places inside it; what is described already is not repeated."""
        title = f"`{place}`" if place else "The case"
        models = [model for model in self._models(node or self._schema) if self._first_time(model, place)]
        if models:
            yield f"## {title}\n"
            value = self._value(node or self._schema)
            if place and "`" in value:
                yield f"Value: {value}.\n"
        for model in models:
            if place and (name := _chosen(model)):
                yield f"### `{place}`: `{name}`\n"
            yield from self._table(model)
        for model in models:
            for key, inner in _properties(model):
                yield from self.sections(f"{place}.{key}".lstrip(".") + self._one_of_many(inner), inner)

    def _one_of_many(self, node: dict[str, Any]) -> str:
        """What follows the key of a list or of named entries in the path of one of them."""
        node = self._resolved(node)
        if node.get("type") == "array":
            return ".0"
        return ".<name>" if isinstance(node.get("additionalProperties"), dict) else ""

    def _first_time(self, model: dict[str, Any], place: str) -> bool:
        key = json.dumps(model, sort_keys=True)
        return self._places.setdefault(key, place) == place

    def _models(self, node: Any) -> Iterator[dict[str, Any]]:
        """The objects that may stand at a place, inside lists and named entries too."""
        node = self._resolved(node)
        if "properties" in node:
            yield node
        for inner in (*node.get("oneOf", ()), *node.get("anyOf", ())):
            yield from self._models(inner)
        for key in ("items", "additionalProperties"):
            if isinstance(node.get(key), dict):
                yield from self._models(node[key])

    def _table(self, model: dict[str, Any]) -> Iterator[str]:
        if text := model.get("description"):
            yield f"{_plain(text.partition(chr(10) * 2)[0])}\n"
        rows = list(_properties(model))
        if not rows:
            return
        yield "| key | value | unit | default | meaning |\n|---|---|---|---|---|"
        required = model.get("required", ())
        for key, node in rows:
            default = "*required*" if key in required else _default(node)
            unit = _plain(node.get("unit", ""))
            yield f"| `{key}` | {self._value(node)} | {unit} | {default} | {_plain(_meaning(node))} |"
        yield ""

    def _value(self, node: Any) -> str:
        """What may stand at a place, in words."""
        node = self._resolved(node)
        if "const" in node:
            return f"`{json.dumps(node['const'])}`"
        if "enum" in node:
            return ", ".join(f"`{json.dumps(value)}`" for value in node["enum"])
        choices = (one for one in (*node.get("oneOf", ()), *node.get("anyOf", ())) if one != self._anywhere)
        inner = [self._value(one) for one in choices]
        choices = ", ".join(choice for choice in inner if choice)
        if choices:
            return ", ".join(dict.fromkeys(choices.split(", ")))
        kind = node.get("type")
        if isinstance(kind, list):
            return ", ".join(WORDS[one] for one in kind)
        if kind == "array":
            return "list of " + re.sub("^((?:whole )?number)", r"\1s", self._value(node["items"]))
        if kind == "object":
            if isinstance(inner := node.get("additionalProperties"), dict):
                inside = self._value(inner)
                return "object" if inside == "object" else f"object of {inside}"
            name = _chosen(node)
            return f"`{json.dumps(name)}`" if name else "object"
        return WORDS.get(kind, "") + _bounds(node)

    def _resolved(self, node: Any) -> Any:
        while "$ref" in node:
            node = self._schema["$defs"][node["$ref"].rpartition("/")[2]]
        return node


def _properties(model: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for key, node in model["properties"].items():
        if key != "$schema" and not (key in CHOSEN_BY and "const" in node):
            yield key, node


def _chosen(model: dict[str, Any]) -> str:
    """The name by which a case file chooses a model."""
    for key in CHOSEN_BY:
        if "const" in model.get("properties", {}).get(key, {}):
            return model["properties"][key]["const"]
    return ""


def _bounds(node: dict[str, Any]) -> str:
    """The limits of a number."""
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    found = [f"{sign} {node[key]:g}" for key, sign in signs.items() if key in node]
    return " " + " and ".join(found) if found else ""


def _default(node: dict[str, Any]) -> str:
    default = node.get("default")
    if default is None or default == {}:
        said = re.search(r"default: (.*?)(?: \[[^\]]*\])?$", node.get("description", ""))
        return _plain(said[1]) if said else "none" if default is None or "$ref" not in node else "as below"
    if isinstance(default, dict):
        return "as below"
    return f"`{json.dumps(default, ensure_ascii=False)}`"


def _meaning(node: dict[str, Any]) -> str:
    """The description without what has a column of its own: the unit and the default."""
    text = re.sub(r" \[[^\]]*\]$", "", node.get("description", ""))
    return re.sub(r"; default: .*$", "", text) if not node.get("default") else text


def _plain(text: str) -> str:
    """Text in a cell of a table: on one line, and no sign taken for markup."""
    line = " ".join(text.replace("``", "`").split())
    return re.sub(r"([|*<_])", r"\\\1", line) if "`" not in line else line.replace("|", "\\|")
