"""The plug-ins of this environment: the usable ones by kind and name, and the problems of the others."""

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
    """An entry point, or one of its plug-ins, that cannot be used, with the reason."""

    distribution: str
    entry_point: str
    reason: str
    kind: str | None = None
    """Kind and name of the plug-in, if they are known."""
    name: str | None = None
    left_out: bool = False
    """Whether it was not loaded because it was not asked for."""

    def __str__(self) -> str:
        if self.left_out:
            return f"plug-in '{self.entry_point}' of distribution '{self.distribution}' {self.reason}"
        return (
            f"plug-in '{self.entry_point}' of distribution '{self.distribution}' is not usable: {self.reason}"
        )

    def concerns(self, kind: str, name: str) -> bool:
        """Whether a case with this kind and name may mean the plug-in of this problem."""
        if self.kind is not None and self.kind != kind:
            return False
        if self.name is not None:
            return self.name == name
        return name in re.split(r"[.:_]", self.entry_point) or name.replace("-", "_") in self.entry_point


class Registry:
    """Every usable plug-in by kind and name, and all problems.

    If two plug-ins have the same kind and name, neither can be used: the result must not depend on the order
    in which they were found.
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
        """Names of the plug-ins of one kind that are installed but cannot be used, in alphabetical order."""
        return sorted({problem.name for problem in self.problems if problem.kind == kind and problem.name})

    def why_not(self, kind: str, name: str) -> list[str]:
        """Sentences on problems that may be the reason why a plug-in is missing; one sentence for a clash."""
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
