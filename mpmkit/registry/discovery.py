"""Discovery of plug-ins, one entry point after the other: a broken one does not break the others."""

from __future__ import annotations

import difflib
import os
import re
from collections.abc import Iterator
from functools import cache
from importlib.metadata import Distribution, EntryPoint, entry_points
from operator import itemgetter
from types import ModuleType

import pluggy

from ..contracts import KINDS, Plugin, hooks
from ..errors import reason
from .registered import Problem, Registered, Registry
from .requirements import check
from .surroundings import settings_and_log_kept

CHOSEN = "MPMKIT_PLUGINS"
"""Environment variable with the distributions to load besides mpmkit's own, separated by commas. If it is not
set, all are loaded; if it is empty, none. ``--no-plugins`` of the command line makes it empty."""


def discover() -> Registry:
    """Load every entry point of the group ``mpmkit``, or those of the distributions that ``CHOSEN`` names."""
    found: list[Registered] = []
    problems: list[Problem] = []
    chosen = _chosen()
    identity = cache(_identity)  # the entry points of a distribution share it, and its metadata may be long
    origins = [(*identity(entry.dist), entry.name, entry) for entry in entry_points(group=hooks.PROJECT)]
    for distribution, version, name, entry_point in sorted(origins, key=itemgetter(0, 2)):
        if chosen is not None and _normal(distribution) not in chosen:
            problems.append(Problem(distribution, name, _why_left_out(), left_out=True))
            continue
        try:
            with settings_and_log_kept():
                loaded = _load(entry_point, distribution, version)
            for one in loaded:
                (found if isinstance(one, Registered) else problems).append(one)  # type: ignore[arg-type]
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # whatever the module of a third party raises must not stop the others
            problems.append(Problem(distribution, name, _reason(error)))
    there = {_normal(distribution) for distribution, *_ in origins}
    for name in sorted((chosen or set()) - there - {_normal(hooks.PROJECT)}):
        problems.append(Problem(name, "*", f"is not installed, though {CHOSEN} names it", left_out=True))
    return Registry(found, problems)


def _chosen() -> set[str] | None:
    """Distributions to load, always with mpmkit's own; None for all."""
    named = os.environ.get(CHOSEN)
    if named is None:
        return None
    return {_normal(hooks.PROJECT), *(_normal(name) for name in named.split(",") if name.strip())}


def _why_left_out() -> str:
    named = os.environ.get(CHOSEN, "")
    return (
        f"was left out, because {CHOSEN} is '{named}'" if named else "was left out, because of --no-plugins"
    )


def _normal(distribution: str) -> str:
    """The name of a distribution as package indices compare it."""
    return re.sub(r"[-_.]+", "-", distribution.strip()).lower()


@cache
def installed() -> Registry:
    """The plug-ins of this environment; they are discovered once in each process."""
    return discover()


def _identity(distribution: Distribution | None) -> tuple[str, str]:
    """Name and version."""
    if distribution is None:
        return "unknown", "unknown"
    metadata = distribution.metadata
    return metadata["Name"], metadata["Version"]


def _reason(error: BaseException) -> str:
    said = reason(error)
    return said.removeprefix(f"{type(error).__name__}: ") if type(error) in (TypeError, ValueError) else said


def _load(entry_point: EntryPoint, distribution: str, version: str) -> list[Registered | Problem]:
    entry_name = entry_point.name
    loaded: list[Registered | Problem] = []
    for kind, plugin in _provided(entry_point.load()):
        try:
            check(plugin, kind)
            loaded.append(Registered(kind, plugin, distribution, version, entry_name))
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            name = getattr(plugin, "name", None)
            known = name if isinstance(name, str) else None
            loaded.append(Problem(distribution, entry_name, _reason(error), kind, known))
    if not loaded:
        raise ValueError("it registers nothing: no function marked @hookimpl returns a plug-in")
    return loaded


def _provided(module: ModuleType) -> Iterator[tuple[str, type[Plugin]]]:
    """Kinds and classes that the hooks of a module return, not yet checked."""
    manager = pluggy.PluginManager(
        hooks.PROJECT
    )  # a new one for each module, so that a module that fails leaves no trace
    manager.add_hookspecs(hooks)
    kinds = {hook: kind for kind, (hook, _) in KINDS.items()}
    manager.register(module)
    for hook in manager.get_hookcallers(module) or []:
        if hook.name not in kinds:  # otherwise a misspelt hook would be ignored without a message
            near = difflib.get_close_matches(hook.name, kinds, n=1)
            hint = f"did you mean {near[0]}?" if near else f"the hooks are {', '.join(kinds)}"
            raise ValueError(f"it has an unknown hook {hook.name}; {hint}")
        for implementation in hook.get_hookimpls():
            plugins = implementation.function()
            if not isinstance(plugins, list | tuple | set):
                raise TypeError(f"{hook.name} returned {plugins!r}; it must return a list of classes")
            for plugin in plugins:
                yield kinds[hook.name], plugin
