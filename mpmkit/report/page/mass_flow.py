"""The results of sources and sinks: how much mass came in and went out, and where."""

from __future__ import annotations

from .source import Source
from .words import length, number

KINDS = (("source", "Mass in", "came in through"), ("sink", "Mass out", "left through"))
"""Dimension of the history, name of the result, and what the mass did."""


def figures(source: Source) -> list[tuple[str, str, str]]:
    """Name, value and explanation of the mass that has passed each source and each sink."""
    found = []
    for kind, result, passed in KINDS:
        masses = _masses(source, kind)
        for name, mass in masses.items():
            label = result if len(masses) == 1 else f"{result}: {name}"
            said = f"{passed} the {kind} {_described(source, kind, name)}"
            found.append((label, f"{number(mass)} kg", said))
    return found


def _masses(source: Source, kind: str) -> dict[str, float]:
    """Mass that has passed by now, kg, by the names of the sources or sinks."""
    history, variable = source.results.history, f"{kind}_mass"
    if variable not in history or not history.sizes["time"]:
        return {}
    last = history[variable].isel(time=-1).values
    return dict(zip(map(str, history[kind].values), map(float, last), strict=True))


def _described(source: Source, kind: str, name: str) -> str:
    """The name of a source or sink, its kind and, for a source, where its mouth is at the start."""
    plugin = source.results.case.get(f"{kind}s", {}).get(name, {}).get("kind", "")
    place = ""
    if kind == "source" and source.case is not None:
        mouth = source.case.mouths[name]
        axis = source.space.axes[mouth.axis]
        direction = f"{'+' if mouth.sign > 0 else '−'}{axis}"
        place = f", at {axis} = {length(mouth.centre[mouth.axis])} in the direction {direction}"
    return f"{name} ({plugin}{place})" if plugin else name
