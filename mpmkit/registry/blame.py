"""Whose fault it is: what a plug-in raises, or gives back, is told in one sentence that names it.

Every call of a plug-in happens inside ``blaming_plugins``, while a case is validated and in all that uses it.
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
"""Modules of the framework that run on behalf of the plug-in that called them."""


class blaming_plugins:
    """Raise PluginStop where a plug-in raises an exception inside the ``with`` block, or is at fault.

    Whatever a plug-in's own code raises is its fault: a ``SystemExit`` and an error class of the framework as
    well, since neither is a plug-in's to raise. An interrupt is nobody's fault. One object serves any number
    of blocks, also one inside another: every step of a run is one, so that a block must cost next to nothing.

    Args:
        plugins: those that are used; they tell whose the plain functions of a plug-in's module are.
        when: gives the step and the time, s, that a run has come to; None outside of a run.

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
                if culprit is None:  # a program that uses the framework called it, and no plug-in did
                    raise TypeError(str(error)) from error
                plugin = culprit[0]
            raise _stop(f"{named(plugin)} {error}", self._when, error.particle) from error
        culprit = _culprit(error, self._plugins)
        if culprit is not None:  # else a fault of the framework, or of the user
            plugin, where = culprit
            raise _stop(f"{named(plugin)} raised {_said(error)} ({where})", self._when) from error


def named(plugin: object) -> str:
    """A plug-in, or its class, as sentences have it."""
    cls = plugin if isinstance(plugin, type) else type(plugin)
    kind = next((kind for kind, (_, contract) in KINDS.items() if issubclass(cls, contract)), None)
    name = getattr(cls, "name", cls.__name__)
    if kind is None:
        return f"the plug-in '{name}'"
    origin = installed().plugins[kind].get(name)
    of = f", of {origin.distribution}" if origin is not None and origin.plugin is cls else ""
    return f"the plug-in '{name}' ({kind.replace('_', ' ')}{of})"


def _stop(what: str, when: Callable[[], tuple[int, float]] | None, particle: int | None = None) -> PluginStop:
    if when is None:
        return PluginStop(what, particle=particle)
    step, time = when()
    return PluginStop(f"stopped at step {step}, t = {time:.6g} s: {what}", step=step, particle=particle)


def _said(error: BaseException) -> str:
    """The kind of an exception and what it says, also of the framework's own kinds."""
    said, kind = reason(error), type(error).__name__
    return said if said.startswith(kind) else f"{kind}: {said}"


def _culprit(
    error: BaseException, plugins: Used, called: bool = False
) -> tuple[Plugin | type[Plugin], str] | None:
    """The plug-in whose code was nearest to where an exception was raised, and the place in it.

    None where code of the framework was nearer, unless it is known to have been ``called`` wrongly.
    """
    for frame, line in reversed(list(traceback.walk_tb(error.__traceback__))):
        module = str(frame.f_globals.get("__name__"))
        if module.partition(".")[0] in ("pydantic", "pydantic_core"):  # says what is wrong with values
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
