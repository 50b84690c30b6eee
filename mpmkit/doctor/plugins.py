"""The plug-ins that are installed, and those that cannot be used."""

from __future__ import annotations

from collections import Counter

from .finding import Finding


def plugins() -> Finding:
    """Number of plug-ins of each distribution, and the problems of all."""
    from ..registry import installed

    registry = installed()
    counts = Counter(
        f"{one.distribution} {one.version}" for kind in registry.plugins.values() for one in kind.values()
    )
    found = Finding({name: f"{count} plug-ins" for name, count in sorted(counts.items())})
    for problem in registry.problems:
        if problem.left_out:
            found.facts[f"{problem.distribution} ({problem.entry_point})"] = "left out"
        else:
            found.problems.append(str(problem))
    return found
