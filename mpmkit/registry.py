"""Discovery of plug-ins, entry point by entry point: one that is broken never breaks the others."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import EntryPoint, entry_points

import pluggy

from .contracts import API_VERSION, KINDS, Plugin, hooks


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

    def __str__(self) -> str:
        return f"plug-in '{self.entry_point}' of distribution '{self.distribution}' is not usable: {self.reason}"


@dataclass
class Registry:
    """Every usable plug-in by kind and name, and every problem met on the way."""

    plugins: dict[str, dict[str, Registered]] = field(default_factory=lambda: {kind: {} for kind in KINDS})
    problems: list[Problem] = field(default_factory=list)

    def of_kind(self, kind: str) -> dict[str, type[Plugin]]:
        """Names and classes of one kind, in alphabetical order."""
        return {name: found.plugin for name, found in sorted(self.plugins[kind].items())}

    def add(self, found: Registered) -> None:
        """Register one plug-in. Two of the same kind and name are an error of both, whatever their order."""
        same_kind = self.plugins[found.kind]
        clash = same_kind.get(found.name)
        if clash is not None or found.name in self._refused(found.kind):
            rivals = [found] if clash is None else [clash, found]
            for rival in rivals:
                reason = f"{found.kind} '{found.name}' is registered more than once"
                self.problems.append(Problem(rival.distribution, rival.entry_point, reason))
            same_kind.pop(found.name, None)
            self._refused(found.kind).add(found.name)
        else:
            same_kind[found.name] = found

    def _refused(self, kind: str) -> set[str]:
        return self.__dict__.setdefault("_refused_names", {}).setdefault(kind, set())


def discover() -> Registry:
    """Load every entry point of the group ``mpmkit``."""
    registry = Registry()
    manager = pluggy.PluginManager(hooks.PROJECT)
    manager.add_hookspecs(hooks)
    for entry_point in sorted(entry_points(group=hooks.PROJECT), key=_origin):
        distribution, name = _origin(entry_point)
        try:
            for found in _load(manager, entry_point):
                registry.add(found)
        except Exception as error:  # whatever a stranger's module does must stay its own problem
            reason = f"{type(error).__name__}: {error}"
            registry.problems.append(Problem(distribution, name, reason))
    return registry


@cache
def installed() -> Registry:
    """The plug-ins of this environment, discovered once a process."""
    return discover()


def _origin(entry_point: EntryPoint) -> tuple[str, str]:
    return (entry_point.dist.name if entry_point.dist else "unknown", entry_point.name)


def _load(manager: pluggy.PluginManager, entry_point: EntryPoint) -> list[Registered]:
    distribution, entry_name = _origin(entry_point)
    version = entry_point.dist.version if entry_point.dist else "unknown"
    unique_name = f"{distribution}:{entry_name}"
    module = entry_point.load()
    manager.register(module, name=unique_name)
    try:
        manager.check_pending()  # a misspelt hook would otherwise stay silent
        found = []
        for kind, (hook, contract) in KINDS.items():
            implementations = [i for i in getattr(manager.hook, hook).get_hookimpls() if i.plugin is module]
            for implementation in implementations:
                for plugin in implementation.function():
                    _check(plugin, kind, contract)
                    found.append(Registered(kind, plugin, distribution, version, entry_name))
    except Exception:
        manager.unregister(name=unique_name)
        raise
    if not found:
        raise ValueError("it registers nothing: no function is marked @hookimpl")
    return found


def _check(plugin: object, kind: str, contract: type) -> None:
    if not (isinstance(plugin, type) and issubclass(plugin, contract)):
        raise TypeError(f"{plugin!r} is not a subclass of {contract.__name__}, as a {kind} must be")
    for attribute in ("name", "citation"):
        if not isinstance(getattr(plugin, attribute, None), str):
            raise TypeError(f"{plugin.__name__} has no '{attribute}'")
    if plugin.api_version != API_VERSION:
        raise ValueError(f"it is written for API version {plugin.api_version}, this is version {API_VERSION}")
