"""From pydantic's errors to one sentence a person can act on: the field, the value, and what is allowed."""

from __future__ import annotations

import difflib
import json
from typing import Any

from pydantic import BaseModel, ValidationError

from ..registry import Registry

SENTENCES = {
    "missing": "{field} is missing{unit}",
    "float_type": "{field} is {value}; it must be a number{unit}",
    "int_type": "{field} is {value}; it must be a whole number",
    "int_from_float": "{field} is {value}; it must be a whole number",
    "string_type": "{field} is {value}; it must be a text",
    "bool_type": "{field} is {value}; it must be true or false",
    "list_type": "{field} is {value}; it must be a list",
    "dict_type": "{field} is {value}; it must be an object",
    "model_type": "{field} is {value}; it must be an object",
    "model_attributes_type": "{field} is {value}; it must be an object",
    "finite_number": "{field} is {value}; it must be finite",
    "greater_than": "{field} is {value}; it must be greater than {gt:g}{unit}",
    "greater_than_equal": "{field} is {value}; it must be at least {ge:g}{unit}",
    "less_than": "{field} is {value}; it must be less than {lt:g}{unit}",
    "less_than_equal": "{field} is {value}; it must be at most {le:g}{unit}",
    "literal_error": "{field} is {value}; it must be {expected}",
    "too_short": "{field} has {actual_length} entries; it needs at least {min_length}",
    "too_long": "{field} has {actual_length} entries; it may have at most {max_length}",
    "string_pattern_mismatch": "{field} is {value}; it must match {pattern}",
    "string_too_long": "{field} is too long; it may have at most {max_length} characters",
}


def explain(error: ValidationError, data: Any, model: type[BaseModel], registry: Registry) -> str:
    """The first error as a sentence, and how many more there are."""
    errors = error.errors(include_url=False)
    first = min(errors, key=_rank)
    more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
    return _sentence(first, data, model, registry) + more


def _rank(item: Any) -> tuple[int, int]:
    # A misspelt key usually causes a missing one as well: tell of the misspelling.
    return (0 if item["type"] == "extra_forbidden" else 1, 0)


def _sentence(item: Any, data: Any, model: type[BaseModel], registry: Registry) -> str:
    keys = _keys_in_data(item["loc"], data, missing=item["type"] == "missing")
    field = ".".join(str(key) for key in keys) or "the case"
    kind, context = item["type"], item.get("ctx", {})
    if kind == "extra_forbidden":
        return _unknown_key(keys, item["loc"], model)
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        return _unknown_choice(field, item, registry)
    if kind == "value_error":
        text = str(context["error"])
        return f"{field}: {text}" if keys else text
    if kind in SENTENCES:
        unit = _unit(item["loc"], model)
        values = {**context, "field": field, "value": _shown(item["input"]), "unit": f" [{unit}]" if unit else ""}
        return SENTENCES[kind].format(**values)
    return f"{field} is {_shown(item['input'])}; {item['msg'][0].lower()}{item['msg'][1:]}"


def _shown(value: Any) -> str:
    try:
        text = json.dumps(value)
    except (TypeError, ValueError):
        text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _keys_in_data(loc: tuple, data: Any, missing: bool) -> list:
    """The location without the tags that pydantic puts in for the members of unions."""
    keys: list = []
    here = data
    for depth, key in enumerate(loc):
        last = depth == len(loc) - 1
        if isinstance(here, dict) and key in here:
            keys.append(key)
            here = here[key]
        elif isinstance(here, list) and isinstance(key, int) and key < len(here):
            keys.append(key)
            here = here[key]
        elif last and missing:
            keys.append(key)
    return keys


def _models_at(loc: tuple, model: Any) -> Any:
    """JSON Schema at a location, tags included, or None."""
    schema = model.model_json_schema()
    definitions = schema.get("$defs", {})

    def resolve(node: Any) -> Any:
        while isinstance(node, dict) and "$ref" in node:
            node = definitions[node["$ref"].rsplit("/", 1)[1]]
        return node

    def candidates(node: Any) -> list:
        node = resolve(node)
        found = [node]
        for option in (node or {}).get("anyOf", []) + (node or {}).get("oneOf", []):
            found += candidates(option)
        return found

    here = [schema]
    for key in loc:
        following: list = []
        options = [option for node in here for option in candidates(node)]
        for option in options:
            if isinstance(key, int) and "items" in option:
                following.append(option["items"])
            elif key in option.get("properties", {}):
                following.append(option["properties"][key])
        if not following:  # a tag: keep the members that carry it
            tagged = [
                option
                for option in options
                if any(rule.get("const") == key for rule in option.get("properties", {}).values())
            ]
            following = tagged or here
        here = following
    return [option for node in here for option in candidates(node)]


def _unit(loc: tuple, model: type[BaseModel]) -> str | None:
    for node in _models_at(loc, model):
        if node.get("unit"):
            return node["unit"]
    return None


def _unknown_key(keys: list, loc: tuple, model: type[BaseModel]) -> str:
    allowed = sorted({name for node in _models_at(loc[:-1], model) for name in node.get("properties", {})})
    place = ".".join(str(key) for key in keys[:-1]) or "the case"
    close = difflib.get_close_matches(str(loc[-1]), allowed, n=1)
    hint = f"did you mean '{close[0]}'?" if close else f"it may have {', '.join(allowed)}"
    return f"{place} has an unknown key '{loc[-1]}'; {hint}"


def _unknown_choice(field: str, item: Any, registry: Registry) -> str:
    context, value = item.get("ctx", {}), item["input"]
    tag = context.get("tag")
    if tag is None and isinstance(value, dict):
        key = str(context.get("discriminator", "'name'")).strip("'")
        key = "name" if "(" in key else key
        return f"{field} does not say its '{key}'"
    allowed = str(context.get("expected_tags", "")).replace("'", "")
    close = difflib.get_close_matches(str(tag), allowed.split(", "), n=1)
    hint = f" (did you mean '{close[0]}'?)" if close else ""
    broken = "".join(f"; {problem}" for problem in registry.problems)
    return f"{field} is {_shown(tag if tag is not None else value)}; it must be one of {allowed}{hint}{broken}"
