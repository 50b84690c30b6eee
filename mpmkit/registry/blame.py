"""Errors of plug-ins: one sentence names the plug-in that raised an exception or returned a wrong value.

Every call of a plug-in is inside ``blaming_plugins``, in the validation of a case and in everything after it.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Sequence
from pathlib import Path

from ..contracts import KINDS, Plugin
from ..errors import PluginFault, PluginStop, reason
from .discovery import installed
from .surroundings import Settings, restore, settings

Used = Sequence[tuple[str, Plugin | type[Plugin]]]
"""Plug-ins, or their classes, each with its kind."""
NEUTRAL = ("mpmkit.contracts.", "mpmkit.kernels.")
"""Modules of the framework that plug-ins call; an exception in them is a fault of the caller."""


class blaming_plugins:
    """Raise PluginStop if a plug-in raises an exception inside the ``with`` block, or is at fault.

    Every exception of a plug-in's own code is its fault, also a ``SystemExit`` and the error classes of the
    framework, which a plug-in must not raise. An interrupt is not a fault. One object can be used for any
    number of blocks, also nested ones. Every step of a run is a block, so that a block must cost very little.

    Args:
        plugins: the plug-ins that are used; a plain function of the module of one of them belongs to it.
        when: returns the present step and time, s, of a run; None outside of a run.

    Raises:
        PluginStop: says which plug-in raised what, and where; the exception itself is its cause.
    """

    def __init__(self, plugins: Used = (), when: Callable[[], tuple[int, float]] | None = None) -> None:
        self._plugins = plugins
        self._when = when
        self._settings: list[Settings] = []

    def __enter__(self) -> None:
        self._settings.append(settings())

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        restore(self._settings.pop())
        if error is None or isinstance(error, KeyboardInterrupt | PluginStop):
            return
        if isinstance(error, PluginFault):
            plugin = error.plugin
            if plugin is None:
                culprit = _culprit(error, self._plugins, called=True)
                if culprit is None:  # the caller is a program that uses the framework, not a plug-in
                    raise TypeError(str(error)) from error
                plugin = culprit[0]
            raise _stop(f"{named(plugin)} {error}", self._when, error.particle) from error
        culprit = _culprit(error, self._plugins)
        if culprit is not None:  # otherwise it is a fault of the framework, or of the user
            plugin, where = culprit
            raise _stop(f"{named(plugin)} raised {_said(error)} ({where})", self._when) from error


def named(plugin: object) -> str:
    """A plug-in, or its class, for a sentence."""
    cls = plugin if isinstance(plugin, type) else type(plugin)
    kind = next((kind for kind, (_, contract) in KINDS.items() if issubclass(cls, contract)), None)
    name = getattr(cls, "name", cls.__name__)
    if kind is None:
        return f"the plug-in '{name}'"
    origin = installed().plugins[kind].get(name)
    of = f", of {origin.distribution}" if origin is not None and issubclass(cls, origin.plugin) else ""
    return f"the plug-in '{name}' ({kind.replace('_', ' ')}{of})"


def _stop(what: str, when: Callable[[], tuple[int, float]] | None, particle: int | None = None) -> PluginStop:
    if when is None:
        return PluginStop(what, particle=particle)
    step, time = when()
    return PluginStop(f"stopped at step {step}, t = {time:.6g} s: {what}", step=step, particle=particle)


def _said(error: BaseException) -> str:
    """The class of an exception and its message."""
    said, kind = reason(error), type(error).__name__
    return said if said.startswith(kind) else f"{kind}: {said}"


def _culprit(
    error: BaseException, plugins: Used, called: bool = False
) -> tuple[Plugin | type[Plugin], str] | None:
    """The plug-in whose code is nearest to the origin of an exception, and the line in it.

    None if code of the framework is nearer, except if it is known that it was ``called`` wrongly.
    """
    for frame, line in reversed(list(traceback.walk_tb(error.__traceback__))):
        module = str(frame.f_globals.get("__name__"))
        if module.partition(".")[0] in ("pydantic", "pydantic_core"):  # pydantic reports wrong values
            continue
        place = f"{Path(frame.f_code.co_filename).name}, line {line}"
        owner = frame.f_locals.get("self", frame.f_locals.get("cls"))
        if isinstance(owner, Plugin) or (isinstance(owner, type) and issubclass(owner, Plugin)):
            return owner, place
        for _, plugin in plugins:
            if module == (plugin if isinstance(plugin, type) else type(plugin)).__module__:
                return plugin, place
        if module.startswith("mpmkit.") and not module.startswith(NEUTRAL) and not called:
            return None
    return None
