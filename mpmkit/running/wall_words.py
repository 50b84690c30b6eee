"""Walls in words: surface, contact and motion of each."""

from __future__ import annotations

from typing import Any

from ..case.model import Case, Wall
from ..case.plugins import plugins_of
from ..contracts import Plugin
from ..geometry import Motion
from ..registry import audit
from ..registry.blame import blaming_plugins

NOT_SAID = ("kind", "name", "motion")
"""Parameters of a plug-in that its sentence already contains."""


def wall_sentences(case: Case) -> list[str]:
    """A sentence for each wall of a case.

    Raises:
        PluginStop: a surface is at fault.
    """
    with blaming_plugins(plugins_of(case)):
        return [
            f"wall {name}: {_plugin(wall.surface)}; contact {_plugin(wall.contact)}; {_motion(wall, case)}"
            for name, wall in case.walls.items()
        ]


def _plugin(plugin: Plugin) -> str:
    """A plug-in with its parameters that are not None, as in "coulomb (coefficient 0.2)"."""
    given = [
        f"{key} {_value(value)}{_unit(plugin, key)}"
        for key, value in plugin.model_dump(mode="json").items()
        if key not in NOT_SAID and value is not None
    ]
    return f"{plugin.name} ({', '.join(given)})" if given else str(plugin.name)


def _value(value: Any) -> str:
    """A parameter; for a part with its own parameters, such as a shape, only its kind."""
    if isinstance(value, dict):
        return str(value.get("kind", "given"))
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float | int):
        return f"{value:g}"
    if isinstance(value, list):
        return f"({', '.join(map(_value, value))})"
    return str(value)


def _unit(plugin: Plugin, key: str) -> str:
    field = type(plugin).model_fields.get(key)
    extra = None if field is None else field.json_schema_extra
    unit = extra.get("unit") if isinstance(extra, dict) else None
    return "" if unit in (None, "1") else f" {unit}"


def _motion(wall: Wall, case: Case) -> str:
    """How a wall moves; for a motion of a plug-in, its largest speed."""
    motion = getattr(wall.surface, "motion", None)
    if isinstance(motion, Motion):
        return motion.in_words(case.space_.axes)
    fastest = audit.placed(wall.surface, case.space_).fastest(0.0, case.end)
    return f"moves at up to {fastest:.3g} m/s" if fastest > 0 else "at rest"
