"""The values that a JSON Schema allows at one place of a case, in words."""

from __future__ import annotations

import json
from collections.abc import Iterable
from copy import copy
from typing import Any

Node = dict[str, Any]
NOUNS = {"string": "a text", "boolean": "true or false", "number": "a number", "integer": "a whole number"}
PLURALS = {"string": "texts", "number": "numbers", "integer": "whole numbers", "object": "objects"}
BOUNDS = {
    "exclusiveMinimum": "above",
    "minimum": "at least",
    "exclusiveMaximum": "below",
    "maximum": "at most",
}
LONGEST = 60
"""Most characters of a value that are shown."""


class Place:
    """The alternatives of a schema at one place of a document that agree with the rest of the document.

    Args:
        schema: the whole JSON Schema.
        document: the document that the schema describes.
        path: keys and indices from the root of the document; the last ones need not exist.
    """

    def __init__(self, schema: Node, document: Any, path: Iterable[str | int] = ()) -> None:
        self._definitions = schema.get("$defs", {})
        self._document = document
        self.nodes = self._alternatives(schema)
        self.unit: str | None = None
        """Unit of the quantity at this place, or of the quantity that contains it."""
        for key in path:
            self._descend(key)

    def keys(self) -> list[str]:
        """Keys that an object may have here."""
        return list(dict.fromkeys(key for node in self._meant() for key in node.get("properties", {})))

    def choices(self) -> list[Any]:
        """The allowed constant values here."""
        return [value for node in self.nodes for value in _constants(node)]

    def takes_numbers(self) -> bool:
        """Whether a number is allowed here."""
        return any(node.get("type") in ("number", "integer") for node in self.nodes)

    def selector(self) -> tuple[str, list[Any]] | None:
        """The key whose value selects one of several objects, and its values."""
        objects = [node["properties"] for node in self.nodes if "properties" in node]
        for key in objects[0] if objects else ():
            values = [value for node in objects for value in _constants(node.get(key, {}))]
            if len(values) == len(objects):
                return key, values
        return None

    def describe(self) -> str:
        """The alternatives as the end of "it must be …"."""
        choices, selector = self.choices(), self.selector()
        parts = [one_of(choices)] if choices else []
        for node in self.nodes:
            if not (_constants(node) or "properties" in node or node.get("type") == "null"):
                parts.append(self._describe(node))
        if selector is not None:
            key, values = selector
            such = f"such a '{key}'" if values == choices else f"a '{key}' that is {one_of(values)}"
            parts.append(f"an object with {such}")
        elif any("properties" in node for node in self.nodes):
            parts.append(self._object())
        return ", or ".join(parts) or "something else"

    def written_out(self, value: Any) -> str | None:
        """The object that contains the constant ``value``, with its required keys; None if there is none."""
        for node in self.nodes:
            properties = node.get("properties", {})
            named = [key for key, rule in properties.items() if "const" in rule and rule["const"] == value]
            if named:
                rest = [key for key in node.get("required", []) if key not in named]
                entries = [f'"{named[0]}": {json.dumps(value)}', *(f'"{key}": …' for key in rest)]
                return f"{{{', '.join(entries)}}}"
        return None

    def _object(self) -> str:
        """The keys of an object, the required ones first."""
        objects = [node for node in self._meant() if "properties" in node]
        needed = [key for key in self.keys() if all(key in node.get("required", []) for node in objects)]
        others = [key for key in self.keys() if key not in needed]
        if not needed:
            return f"an object that may have {_keys(others)}"
        return f"an object with {_keys(needed)}" + (f", and optionally {_keys(others)}" if others else "")

    def _describe(self, node: Node) -> str:
        kind = node.get("type", "")
        unit = f", in {self.unit}" if self.unit not in (None, "1") else ""
        if "allowed" in node:
            return node["allowed"]
        if kind in ("number", "integer"):
            return NOUNS[kind] + _limits(node) + unit
        if kind == "array":
            return f"a list of {self._entries(node)}{unit}"
        if kind == "object" and isinstance(node.get("additionalProperties"), dict):
            value = copy(self)
            value.nodes = self._alternatives(node["additionalProperties"])
            return f"an object in which each value is {value.describe()}"
        if "pattern" in node:
            return f"a text that matches {node['pattern']}"
        return NOUNS.get(kind, "something else")

    def _entries(self, node: Node) -> str:
        items = self._alternatives(node.get("items", {}))
        choices = [value for item in items for value in _constants(item)]
        if choices:
            return one_of(choices)
        kinds = {str(item.get("type")) for item in items}
        return _count(node) + (PLURALS.get(kinds.pop(), "entries") if len(kinds) == 1 else "entries")

    def _descend(self, key: str | int) -> None:
        children = []
        for node in self._meant(but=key):
            if isinstance(key, int):
                children.append(node.get("items"))
            else:
                children.append(node.get("properties", {}).get(key, node.get("additionalProperties")))
        known = [child for child in children if isinstance(child, dict)]
        self.unit = next((child["unit"] for child in known if "unit" in child), self.unit)
        self.nodes = [node for child in known for node in self._alternatives(child)]
        try:
            self._document = self._document[key]
        except (KeyError, IndexError, TypeError):
            self._document = None

    def _meant(self, but: str | int | None = None) -> list[Node]:
        """The alternatives whose constants agree with the document, apart from the constant at one key."""
        document = self._document
        if not isinstance(document, dict):
            return self.nodes

        def agrees(node: Node) -> bool:
            rules = node.get("properties", {}).items()
            return all(
                document.get(key, rule["const"]) == rule["const"]
                for key, rule in rules
                if "const" in rule and key != but
            )

        return [node for node in self.nodes if agrees(node)]

    def _alternatives(self, node: Node) -> list[Node]:
        while "$ref" in node:
            node = self._definitions[node["$ref"].rsplit("/", 1)[1]]
        options = node.get("anyOf") or node.get("oneOf")
        return (
            [node] if options is None else [leaf for option in options for leaf in self._alternatives(option)]
        )


def shown(value: Any) -> str:
    """A value as in the file, shortened."""
    try:
        text = json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError, RecursionError):
        text = repr(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def one_of(values: list[Any]) -> str:
    """``"a", "b" or "c"``, written as in the file."""
    return _listed([json.dumps(value, ensure_ascii=False) for value in values], "or")


def _keys(names: list[str]) -> str:
    return f"the key{'s' * (len(names) > 1)} {_listed([repr(name) for name in names], 'and')}"


def _listed(words: list[str], last: str) -> str:
    return f" {last} ".join(part for part in (", ".join(words[:-1]), words[-1]) if part)


def _constants(node: Node) -> list[Any]:
    return [node["const"]] if "const" in node else node.get("enum", [])


def _limits(node: Node) -> str:
    limits = " and ".join(f"{words} {node[key]:g}" for key, words in BOUNDS.items() if key in node)
    return f" of {limits}" if limits.startswith("at") else f" {limits}".rstrip()


def _count(node: Node) -> str:
    least, most = node.get("minItems"), node.get("maxItems")
    if least is not None and most is not None:
        return f"{least} " if least == most else f"{least} to {most} "
    if least == 1:
        return "one or more "
    return f"at least {least} " if least is not None else f"at most {most} " if most is not None else ""
