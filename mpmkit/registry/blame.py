"""Whose fault it is: what a plug-in raises, or gives back, is told in one sentence that names it."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from ..contracts import Plugin
from ..errors import GuardStop, MpmkitError, PluginFault, reason
from .discovery import installed

Used = Sequence[tuple[str, Plugin]]
"""Plug-ins, each with its kind."""
GUARD = "plug-in-error"
NEUTRAL = ("mpmkit.contracts.", "mpmkit.kernels.")
"""Modules of the framework that run on behalf of the plug-in that called them."""


@contextmanager
def blaming_plugins(
    plugins: Used, when: Callable[[], tuple[int, float]] = lambda: (0, 0.0)
) -> Iterator[None]:
    """Stop a run inside the block by a guard where one of its plug-ins raises an exception, or is at fault.

    Args:
        plugins: those that may be to blame, each with its kind.
        when: gives the step and the time, s, that the run has come to.

    Raises:
        GuardStop: says which plug-in raised what, and where; the exception itself is its cause.
    """
    try:
        yield
    except MpmkitError:
        raise
    except PluginFault as fault:
        step, time = when()
        sentence = (
            f"stopped at step {step}, t = {time:.6g} s: the plug-in {_named(fault.plugin, plugins)} {fault}"
        )
        raise GuardStop(GUARD, sentence, step=step, particle=fault.particle) from fault
    except Exception as error:
        culprit = _culprit(error, plugins)
        if culprit is None:  # a fault of the framework: it is not to be mistaken for a stranger's
            raise
        (step, time), (plugin, where) = when(), culprit
        what = f"the plug-in {plugin} raised {reason(error)} ({where})"
        raise GuardStop(GUARD, f"stopped at step {step}, t = {time:.6g} s: {what}", step=step) from error


def _culprit(error: Exception, plugins: Used) -> tuple[str, str] | None:
    """The plug-in whose code was nearest to where the exception was raised, and the place in it."""
    for frame, line in reversed(list(traceback.walk_tb(error.__traceback__))):
        module = str(frame.f_globals.get("__name__"))
        owner = type(frame.f_locals.get("self"))
        for kind, plugin in plugins:
            if owner is type(plugin) or module == type(plugin).__module__:
                return _described(kind, plugin), f"{Path(frame.f_code.co_filename).name}, line {line}"
        if module.startswith("mpmkit.") and not module.startswith(NEUTRAL):
            return None
    return None


def _named(plugin: object, plugins: Used) -> str:
    """The plug-in as sentences have it."""
    for kind, used in plugins:
        if type(used) is type(plugin):
            return _described(kind, used)
    return type(plugin).__name__


def _described(kind: str, plugin: Plugin) -> str:
    origin = installed().plugins[kind].get(plugin.name)
    of = f", of {origin.distribution}" if origin is not None and origin.plugin is type(plugin) else ""
    return f"'{plugin.name}' ({kind.replace('_', ' ')}{of})"
