"""Discovery of plug-ins, entry point by entry point: one that is broken never breaks the others."""

from __future__ import annotations

import difflib
import inspect
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from types import ModuleType

import pluggy

from .contracts import API_VERSION, KINDS, Plugin, ShapeFunction, hooks
from .contracts.shape import MOST_NODES

RESERVED = {"law": {"law", "density", "sound_speed", "equation_of_state"}}
"""Parameters that a plug-in cannot have, because something else stands at that key of a case."""
CHOSEN = "MPMKIT_PLUGINS"
"""Environment variable that names, with commas between, the distributions to load beside mpmkit's own; all of
them if it is not set, none if it is empty. ``--no-plugins`` of the command line empties it."""
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")


@dataclass(frozen=True)
class Registered:
    """A plug-in and where it comes from."""

    kind: str
    plugin: type[Plugin]
    distribution: str
    version: str
    entry_point: str

    @property
    def name(self) -> str:
        return self.plugin.name


@dataclass(frozen=True)
class Problem:
    """An entry point, or one plug-in of it, that cannot be used, and why."""

    distribution: str
    entry_point: str
    reason: str
    kind: str | None = None
    """Kind and name of the plug-in, where the entry point got far enough to say them."""
    name: str | None = None
    left_out: bool = False
    """Whether nothing is wrong with it but that nobody asked for it."""

    def __str__(self) -> str:
        if self.left_out:
            return f"plug-in '{self.entry_point}' of distribution '{self.distribution}' {self.reason}"
        return (
            f"plug-in '{self.entry_point}' of distribution '{self.distribution}' is not usable: {self.reason}"
        )

    def concerns(self, kind: str, name: str) -> bool:
        """Whether a case that asks for this plug-in may mean this one."""
        if (self.kind, self.name) == (kind, name):
            return True
        return name in re.split(r"[.:_]", self.entry_point) or name.replace("-", "_") in self.entry_point


class Registry:
    """Every usable plug-in by kind and name, and every problem met on the way.

    Two plug-ins of the same kind and name are a problem of both: which one is meant must never be a matter of
    the order in which they were found.
    """

    def __init__(self, found: list[Registered], problems: list[Problem]) -> None:
        self.plugins: dict[str, dict[str, Registered]] = {kind: {} for kind in KINDS}
        self.problems = list(problems)
        for one in found:
            rivals = [other for other in found if (other.kind, other.name) == (one.kind, one.name)]
            if len(rivals) == 1:
                self.plugins[one.kind][one.name] = one
            else:
                origins = " and ".join(f"'{r.entry_point}' of '{r.distribution}'" for r in rivals)
                reason = f"{one.kind} '{one.name}' is registered by {origins}; uninstall all but one of them"
                self.problems.append(Problem(one.distribution, one.entry_point, reason, one.kind, one.name))

    def of_kind(self, kind: str) -> dict[str, type[Plugin]]:
        """Names and classes of one kind, in alphabetical order."""
        return {name: found.plugin for name, found in sorted(self.plugins[kind].items())}


def discover() -> Registry:
    """Load every entry point of the group ``mpmkit``, or those of the distributions that ``CHOSEN`` names."""
    found: list[Registered] = []
    problems: list[Problem] = []
    chosen = _chosen()
    for entry_point in sorted(entry_points(group=hooks.PROJECT), key=_origin):
        distribution, name = _origin(entry_point)
        if chosen is not None and _normal(distribution) not in chosen:
            problems.append(Problem(distribution, name, _why_left_out(), left_out=True))
            continue
        try:
            for one in _load(entry_point):
                (found if isinstance(one, Registered) else problems).append(one)  # type: ignore[arg-type]
        except (
            Exception,
            SystemExit,
        ) as error:  # whatever a stranger's module does must stay its own problem
            problems.append(Problem(distribution, name, _reason(error)))
    there = {_normal(_origin(entry_point)[0]) for entry_point in entry_points(group=hooks.PROJECT)}
    for name in sorted((chosen or set()) - there - {_normal(hooks.PROJECT)}):
        problems.append(Problem(name, "*", f"is not installed, though {CHOSEN} names it", left_out=True))
    return Registry(found, problems)


def _chosen() -> set[str] | None:
    """Distributions to load, None for all of them; mpmkit's own is one of them whatever is asked."""
    named = os.environ.get(CHOSEN)
    if named is None:
        return None
    return {_normal(hooks.PROJECT), *(_normal(name) for name in named.split(",") if name.strip())}


def _why_left_out() -> str:
    named = os.environ.get(CHOSEN, "")
    return f"was left out, since {CHOSEN} is '{named}'" if named else "was left out, as --no-plugins asks"


def _normal(distribution: str) -> str:
    """The name of a distribution as package indices compare it."""
    return re.sub(r"[-_.]+", "-", distribution.strip()).lower()


@cache
def installed() -> Registry:
    """The plug-ins of this environment, discovered once a process."""
    return discover()


def _origin(entry_point: EntryPoint) -> tuple[str, str]:
    return (entry_point.dist.name if entry_point.dist else "unknown", entry_point.name)


def _reason(error: BaseException) -> str:
    text = " ".join(str(error).split())  # in one line: it becomes part of a sentence
    return text if type(error) in (TypeError, ValueError) else f"{type(error).__name__}: {text}"


def _load(entry_point: EntryPoint) -> list[Registered | Problem]:
    distribution, entry_name = _origin(entry_point)
    version = entry_point.dist.version if entry_point.dist else "unknown"
    loaded: list[Registered | Problem] = []
    for kind, plugin in _provided(entry_point.load()):
        try:
            check(plugin, kind)
            loaded.append(Registered(kind, plugin, distribution, version, entry_name))
        except Exception as error:
            name = getattr(plugin, "name", None)
            known = name if isinstance(name, str) else None
            loaded.append(Problem(distribution, entry_name, _reason(error), kind, known))
    if not loaded:
        raise ValueError("it registers nothing: no function marked @hookimpl returns a plug-in")
    return loaded


def _provided(module: ModuleType) -> Iterator[tuple[str, type[Plugin]]]:
    """Kinds and classes that the hooks of a module return, not yet looked at."""
    manager = pluggy.PluginManager(hooks.PROJECT)  # of its own, so that a module that fails leaves no trace
    manager.add_hookspecs(hooks)
    kinds = {hook: kind for kind, (hook, _) in KINDS.items()}
    manager.register(module)
    for hook in manager.get_hookcallers(module) or []:
        if hook.name not in kinds:  # a misspelt hook would otherwise stay silent
            near = difflib.get_close_matches(hook.name, kinds, n=1)
            hint = f"did you mean {near[0]}?" if near else f"the hooks are {', '.join(kinds)}"
            raise ValueError(f"it has an unknown hook {hook.name}; {hint}")
        for implementation in hook.get_hookimpls():
            plugins = implementation.function()
            if not isinstance(plugins, list | tuple | set):
                raise TypeError(f"{hook.name} returned {plugins!r}; it must return a list of classes")
            for plugin in plugins:
                yield kinds[hook.name], plugin


def check(plugin: type[Plugin], kind: str) -> None:
    """Raise a TypeError or ValueError, with the reason, unless a plug-in can be used as one of this kind."""
    contract = KINDS[kind][1]
    if not (isinstance(plugin, type) and issubclass(plugin, contract)):
        raise TypeError(f"{plugin!r} is not a subclass of {contract.__name__}, as a {kind} must be")
    version = getattr(plugin, "api_version", None)
    if version is None:
        raise TypeError(f"{plugin.__name__} has no 'api_version'; this is version {API_VERSION}")
    if version != API_VERSION:
        raise ValueError(f"it is written for API version {version}, this is version {API_VERSION}")
    for attribute in ("name", "citation"):
        if not isinstance(getattr(plugin, attribute, None), str):
            raise TypeError(f"{plugin.__name__} has no '{attribute}'")
    if not NAME.fullmatch(plugin.name):
        raise ValueError(
            f"its name is '{plugin.name}'; it must be of lower-case letters, digits and single hyphens"
        )
    if issubclass(plugin, ShapeFunction):
        support = getattr(plugin, "support", None)
        if support not in range(2, MOST_NODES + 1):
            raise ValueError(f"its support is {support}; it must be 2 to {MOST_NODES} nodes along an axis")
    if inspect.isabstract(plugin):
        missing = ", ".join(sorted(plugin.__abstractmethods__))
        raise TypeError(f"{plugin.__name__} lacks {missing}, which a {contract.__name__} must have")
    for parameter in RESERVED.get(kind, {"name"}) & set(plugin.model_fields):
        raise ValueError(
            f"it has a parameter '{parameter}', which a {kind} cannot have: the case has that key already"
        )
    plugin.model_json_schema()  # a parameter that has none would break the schema of all
