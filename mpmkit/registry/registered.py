"""What was found in this environment: the usable plug-ins by kind and name, and the problems."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ..contracts import KINDS, Plugin


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
        if self.kind is not None and self.kind != kind:
            return False
        if self.name is not None:
            return self.name == name
        return name in re.split(r"[.:_]", self.entry_point) or name.replace("-", "_") in self.entry_point


class Registry:
    """Every usable plug-in by kind and name, and every problem met on the way.

    Two plug-ins of the same kind and name are a problem of both: which one is meant must never be a matter of
    the order in which they were found.
    """

    def __init__(self, found: list[Registered], problems: list[Problem]) -> None:
        self.plugins: dict[str, dict[str, Registered]] = {kind: {} for kind in KINDS}
        self.problems = list(problems)
        self._clashes: dict[tuple[str, str], str] = {}
        for one in found:
            rivals = [other for other in found if (other.kind, other.name) == (one.kind, one.name)]
            if len(rivals) == 1:
                self.plugins[one.kind][one.name] = one
            else:
                origins = " and ".join(f"'{r.entry_point}' of '{r.distribution}'" for r in rivals)
                reason = f"{one.kind} '{one.name}' is registered by {origins}; uninstall all but one of them"
                self.problems.append(Problem(one.distribution, one.entry_point, reason, one.kind, one.name))
                self._clashes[one.kind, one.name] = reason

    def unusable(self, kind: str) -> list[str]:
        """Names of the plug-ins of one kind that are there but cannot be used, in alphabetical order."""
        return sorted({problem.name for problem in self.problems if problem.kind == kind and problem.name})

    def why_not(self, kind: str, name: str) -> list[str]:
        """Sentences on the problems by which a plug-in may be missing; of a clash there is one for all."""
        clash = self._clashes.get((kind, name))
        if clash is not None:
            return [clash]
        return [str(problem) for problem in self.problems if problem.concerns(kind, name)]

    def all(self) -> list[tuple[str, type[Plugin]]]:
        """Kind and class of every usable plug-in."""
        return [(kind, one.plugin) for kind, found in self.plugins.items() for one in found.values()]

    def of_kind(self, kind: str) -> dict[str, type[Plugin]]:
        """Names and classes of one kind, in alphabetical order."""
        return {name: found.plugin for name, found in sorted(self.plugins[kind].items())}
