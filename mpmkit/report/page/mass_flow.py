"""Mass that sources bring in and sinks take out: its results and its chart."""

from __future__ import annotations

from typing import Any

import numpy as np

from .histories import listed, of_curves, rows_of
from .source import Source
from .words import length, number

KINDS = (
    ("source", "Mass in", "came in through", "in through"),
    ("sink", "Mass out", "left through", "out through"),
)
"""Dimension of the history, name of the result, and what the mass did, in a sentence and in a chart."""


def figures(source: Source) -> list[tuple[str, str, str]]:
    """Name, value and explanation of the mass that has passed each source and each sink."""
    found = []
    for kind, result, passed, _ in KINDS:
        masses = _masses(source, kind)
        for name, mass in masses.items():
            label = result if len(masses) == 1 else f"{result}: {name}"
            said = f"{passed} the {kind} {_described(source, kind, name)}"
            found.append((label, f"{number(float(mass[-1]))} kg", said))
    return found


def chart(source: Source) -> dict[str, Any] | None:
    """The masses against time; None for a scene without sources and sinks."""
    rows = rows_of(source)
    curves = [
        {"label": f"{passed} {name}", "values": listed(mass[rows])}
        for kind, _, _, passed in KINDS
        for name, mass in _masses(source, kind).items()
    ]
    return of_curves(source, "Mass in and out", "kg", curves)


def _masses(source: Source, kind: str) -> dict[str, np.ndarray]:
    """Mass that has passed by each time, kg, by the names of the sources or sinks."""
    history, variable = source.results.history, f"{kind}_mass"
    if variable not in history or not history.sizes["time"]:
        return {}
    columns = history[variable].transpose(kind, "time").values
    return dict(zip(map(str, history[kind].values), columns, strict=True))


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
