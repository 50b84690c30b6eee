"""What every plug-in must say of itself, and that it is found."""

from __future__ import annotations

import warnings

from ..contracts import Plugin
from ..contracts.version1 import deprecation
from ..registry import check, installed
from .violation import Violation, require


def descriptor(kind: str, plugin: Plugin) -> None:
    """Name, citation, API version, schema; and parameters that come back from a case file as they were."""
    try:
        check(type(plugin), kind)
    except (TypeError, ValueError) as error:
        raise Violation(str(error)) from None
    old = deprecation(plugin)
    if old is not None:
        warnings.warn(old, DeprecationWarning, stacklevel=2)
    written = plugin.model_dump(mode="json")
    again = type(plugin).model_validate(written)
    require(again == plugin, f"written to a case file and read again, it became {again!r}, not {plugin!r}")


def registered(kind: str, plugin: Plugin) -> None:
    """An entry point of the group ``mpmkit`` leads to it."""
    registry = installed()
    entry = registry.plugins[kind].get(plugin.name)
    if entry is None:
        why = "; ".join(registry.why_not(kind, plugin.name)) or (
            "no entry point of the group 'mpmkit' leads to it; install its distribution, again if its entry "
            "points have changed"
        )
        raise Violation(f"it is not registered: {why}")
    require(
        entry.plugin is type(plugin),
        f"the one that is registered under its name is {entry.plugin.__qualname__} of {entry.distribution}",
    )
