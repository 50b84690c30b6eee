"""What a JSON Schema allows at a place of a case, in words."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

Node = dict[str, Any]
NOUNS = {"string": "a text", "boolean": "true or false", "number": "a number", "integer": "a whole number"}
PLURALS = {"string": "texts", "number": "numbers", "integer": "whole numbers", "object": "objects"}
COUNTS = {"minItems": "at least", "maxItems": "at most"}
BOUNDS = {"exclusiveMinimum": "above", "minimum": "at least", "exclusiveMaximum": "below", "maximum": "at most"}


class Place:
    """The alternatives that a schema has at one place of a document, those which the document excludes left out.

    Args:
        schema: the whole JSON Schema.
        document: what it is to describe.
        path: keys and indices from the root of the document; the last ones need not be there.
    """

    def __init__(self, schema: Node, document: Any, path: Iterable[str | int] = ()) -> None:
        self._definitions = schema.get("$defs", {})
        self.unit: str | None = None
        """Unit of the quantity that the place is, or is an entry of."""
        self.nodes = self._alternatives(schema)
        for key in path:
            self._descend(key, document)
            document = _entry(document, key)

    def keys(self) -> list[str]:
        """Keys that an object may have here."""
        return list(dict.fromkeys(key for node in self.nodes for key in node.get("properties", {})))

    def choices(self) -> list[Any]:
        """Values of which one must stand here."""
        return [value for node in self.nodes for value in _constants(node)]

    def selector(self) -> tuple[str, list[Any]] | None:
        """The key whose value says which of several objects is meant, and its values."""
        objects = [node["properties"] for node in self.nodes if "properties" in node]
        for key in objects[0] if objects else ():
            values = [value for node in objects for value in _constants(node.get(key, {}))]
            if len(values) == len(objects):
                return key, values
        return None

    def describe(self) -> str:
        """The alternatives as the end of "it must be …"."""
        parts = [] if not self.choices() else [one_of(self.choices())]
        objects = [node for node in self.nodes if "properties" in node]
        for node in self.nodes:
            if not (_constants(node) or node in objects or node.get("type") == "null"):
                parts.append(self._describe(node))
        selector = self.selector()
        if selector is not None:
            key, values = selector
            which = "the same" if values == self.choices() else one_of(values)
            parts.append(f"an object whose '{key}' is {which}")
        elif objects:
            parts.append(f"an object with {_listed(self.keys(), 'and')}")
        return ", or ".join(parts)

    def _describe(self, node: Node) -> str:
        if "allowed" in node:
            return node["allowed"]
        kind = node.get("type", "")
        unit = f", in {self.unit}" if self.unit not in (None, "1") else ""
        if kind == "array":
            kinds = {item.get("type") for item in self._alternatives(node.get("items", {}))}
            entries = PLURALS.get(kinds.pop(), "entries") if len(kinds) == 1 else "entries"
            return f"a list of {_count(node)}{entries}{unit}"
        if kind == "object":
            return "an object" + unit
        if kind in ("number", "integer"):
            return " and ".join([NOUNS[kind], *_limits(node)]).replace(" and ", " ", 1) + unit
        if "pattern" in node:
            return f"a text that matches {node['pattern']}"
        return NOUNS.get(kind, "something else")

    def _descend(self, key: str | int, document: Any) -> None:
        children = []
        for node in self._meant(document):
            if isinstance(key, int):
                children.append(node.get("items"))
            else:
                children.append(node.get("properties", {}).get(key, node.get("additionalProperties")))
        known = [child for child in children if isinstance(child, dict)]
        self.unit = next((child["unit"] for child in known if "unit" in child), self.unit)
        self.nodes = [node for child in known for node in self._alternatives(child)]

    def _meant(self, document: Any) -> list[Node]:
        """The alternatives that the document may mean: those whose constant keys agree with it."""

        def agrees(node: Node) -> bool:
            fixed = {key: _constants(rule) for key, rule in node.get("properties", {}).items()}
            return all(document[key] in values for key, values in fixed.items() if values and key in document)

        if isinstance(document, dict):
            return [node for node in self.nodes if agrees(node)]
        return self.nodes

    def _alternatives(self, node: Node) -> list[Node]:
        while "$ref" in node:
            node = self._definitions[node["$ref"].rsplit("/", 1)[1]]
        options = node.get("anyOf") or node.get("oneOf")
        return [node] if options is None else [leaf for option in options for leaf in self._alternatives(option)]


def one_of(values: list[Any]) -> str:
    """``"a", "b" or "c"``, as they would stand in the file."""
    return _listed([json.dumps(value, ensure_ascii=False) for value in values], "or")


def _listed(words: list[str], last: str) -> str:
    return f" {last} ".join(part for part in (", ".join(words[:-1]), words[-1]) if part)


def _constants(node: Node) -> list[Any]:
    return [node["const"]] if "const" in node else node.get("enum", [])


def _entry(document: Any, key: str | int) -> Any:
    try:
        return document[key]
    except (KeyError, IndexError, TypeError):
        return None


def _limits(node: Node) -> list[str]:
    return [f"{words} {node[key]:g}" for key, words in BOUNDS.items() if key in node]


def _count(node: Node) -> str:
    least, most = node.get("minItems"), node.get("maxItems")
    if least is not None and most is not None:
        return f"{least} " if least == most else f"{least} to {most} "
    return "".join(f"{words} {node[key]} " for key, words in COUNTS.items() if key in node)
