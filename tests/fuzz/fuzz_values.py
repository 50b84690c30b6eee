"""Hypothesis strategies of values, as the schema of a case has them."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import strategies as st

from mpmkit.case import case_schema
from mpmkit.case.schema import FORMULA
from mpmkit.registry import installed

SCHEMA = case_schema(installed())
DECADES = {"Pa": (0, 5), "Pa s": (-3, 3), "Pa s^n": (-3, 3), "s": (-2, 3), "1/s": (-2, 3), "kg/m^3": (1, 4)}
"""Powers of ten between which a parameter of a unit is drawn; others are of the order of one."""


def logarithmic(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of four digits between two powers of ten."""
    return st.floats(low, high).map(lambda power: float(f"{10**power:.4g}"))


def resolve(node: dict[str, Any]) -> dict[str, Any]:
    while "$ref" in node:
        node = SCHEMA["$defs"][node["$ref"].rsplit("/", 1)[1]]
    return node


def value_of(node: dict[str, Any]) -> st.SearchStrategy[Any]:
    """What a parameter may be, from its schema."""
    node = resolve(node)
    if "const" in node:
        return st.just(node["const"])
    if "enum" in node:
        return st.sampled_from(node["enum"])
    options = node.get("anyOf") or node.get("oneOf")
    if options:
        carried = {"unit": node["unit"]} if "unit" in node else {}
        numbers = [option for option in options if option != FORMULA]  # a formula gives one of them
        return st.one_of([value_of({**carried, **resolve(option)}) for option in numbers])
    if node["type"] == "null":
        return st.none()
    if node["type"] == "boolean":
        return st.booleans()
    if node["type"] == "object":
        return parameters(node)
    least = max(node.get("minimum", -math.inf), node.get("exclusiveMinimum", -math.inf))
    most = min(node.get("maximum", math.inf), node.get("exclusiveMaximum", math.inf))
    decades = DECADES.get(node.get("unit", "1"), (-1, 0.5))
    drawn = logarithmic(*decades).filter(lambda x: least < x < most)
    return st.one_of(drawn, st.just(float(least))) if node.get("minimum") == least else drawn


@st.composite
def parameters(draw: st.DrawFn, node: dict[str, Any], but: tuple[str, ...] = ()) -> dict[str, Any]:
    """An object of a schema: what must be there, and some of the rest."""
    found = {}
    for key, rule in node["properties"].items():
        if key not in but and (key in node.get("required", ()) or draw(st.booleans())):
            found[key] = draw(value_of(rule))
    return found
