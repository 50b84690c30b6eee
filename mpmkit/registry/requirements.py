"""The requirements for a class to be a plug-in of a kind."""

from __future__ import annotations

import inspect
import re
from collections.abc import Mapping

from ..contracts import (
    API_VERSION,
    KINDS,
    OLDEST_API_VERSION,
    ConstitutiveLaw,
    Contact,
    ParticleField,
    Plugin,
    ShapeFunction,
    StateVariable,
    Surface,
)
from ..contracts.shape import MOST_NODES

RESERVED = {"law": {"law", "density", "sound_speed", "equation_of_state"}}
"""Parameters that a plug-in cannot have, because a case has another value at that key."""
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")


def check(plugin: type[Plugin], kind: str) -> None:
    """Raise a TypeError or ValueError, with the reason, if a class cannot be a plug-in of this kind."""
    contract = KINDS[kind][1]
    if not (isinstance(plugin, type) and issubclass(plugin, contract)):
        raise TypeError(f"{plugin!r} is not a subclass of {contract.__name__}, as a {kind} must be")
    _check_version(plugin)
    for attribute in ("name", "citation"):
        if not isinstance(getattr(plugin, attribute, None), str):
            raise TypeError(f"{plugin.__name__} has no '{attribute}'")
    if not NAME.fullmatch(plugin.name):
        raise ValueError(
            f"its name is '{plugin.name}'; it must be of lower-case letters, digits and single hyphens"
        )
    if issubclass(plugin, ShapeFunction):
        support = getattr(plugin, "support", None)
        if not isinstance(support, int) or support not in range(2, MOST_NODES + 1):
            raise ValueError(f"its support is {support}; it must be 2 to {MOST_NODES} nodes along an axis")
    if inspect.isabstract(plugin):
        missing = ", ".join(sorted(plugin.__abstractmethods__))
        raise TypeError(f"{plugin.__name__} lacks {missing}, which a {contract.__name__} must have")
    if issubclass(plugin, Surface) and (plugin.placed, plugin.distance) == (Surface.placed, Surface.distance):
        raise TypeError(f"{plugin.__name__} lacks distance, which a Surface must have")
    for parameter in RESERVED.get(kind, {contract.named_by}) & set(plugin.model_fields):
        raise ValueError(
            f"it has a parameter '{parameter}', which a {kind} cannot have: the case has that key already"
        )
    if issubclass(plugin, ConstitutiveLaw):
        _check_variables(plugin, "state", plugin.state)
    if issubclass(plugin, ParticleField):
        _check_field(plugin)
    if issubclass(plugin, Contact):
        _check_variables(plugin, "memory", plugin.memory)
        for name, variable in plugin.memory.items():
            if variable.shape != ():
                raise ValueError(
                    f"its memory '{name}' has the shape {variable.shape}; it must be a number at each node"
                )
    plugin.model_json_schema()  # a parameter without a schema would break the schema of cases


def _check_field(plugin: type[ParticleField]) -> None:
    for attribute in ("unit", "long_name"):
        if not isinstance(getattr(plugin, attribute, None), str):
            raise TypeError(f"{plugin.__name__} has no '{attribute}'")
    shape = plugin.shape
    if not isinstance(shape, tuple) or not all(type(side) is int and side > 0 for side in shape):
        raise ValueError(f"its shape is {shape!r}; it must be (), or whole numbers above 0 such as (3,)")


def _check_version(plugin: type[Plugin]) -> None:
    version = getattr(plugin, "api_version", None)
    if version is None:
        raise TypeError(
            f"{plugin.__name__} has no 'api_version'; for this mpmkit write api_version = {API_VERSION}"
        )
    if type(version) is not int:
        what = "text" if isinstance(version, str) else f"of type {type(version).__name__}"
        raise TypeError(
            f"its api_version is {version!r}, which is {what}; "
            f"it must be a whole number, such as {API_VERSION}"
        )
    if OLDEST_API_VERSION <= version <= API_VERSION:
        return
    supported = f"this mpmkit supports versions {OLDEST_API_VERSION} to {API_VERSION}"
    hint = "update mpmkit" if version > API_VERSION else "what has changed: docs/plugins.md#versions"
    raise ValueError(f"it is written for version {version} of the plug-in contracts; {supported}; {hint}")


def _check_variables(plugin: type[Plugin], what: str, variables: Mapping[str, StateVariable]) -> None:
    for name, variable in variables.items():
        if not isinstance(variable, StateVariable):
            raise TypeError(f"its {what} '{name}' is {variable!r}; it must be a StateVariable")
        if not isinstance(variable.initial, str):
            try:
                variable.at_start()
            except ValueError as error:
                raise ValueError(f"its {what} '{name}' {error}") from None
        elif variable.initial not in plugin.model_fields and not hasattr(plugin, variable.initial):
            parameters = ", ".join(plugin.model_fields) or "none"
            of = "law" if what == "state" else "contact"
            raise ValueError(
                f"its {what} '{name}' starts from '{variable.initial}', which is not a parameter of the "
                f"{of}; its parameters: {parameters}"
            )
