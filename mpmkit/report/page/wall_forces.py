"""Section: force, torque and power of the walls, and the weight that they carry."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...case.model import STANDARD_GRAVITY
from ..wall_forces import charts_of, chosen_of
from .histories import listed, of_curves, rows_of
from .section import Section, note, pairs
from .section import charts as charts_side_by_side
from .source import Source
from .words import number

NEGLIGIBLE = 1e-4
"""A chart or curve below this part of the largest value is left out: it shows only noise."""
LAST = 0.1
"""The final force is the mean over this last part of the rows."""


def section(source: Source) -> Section | None:
    """The forces of the walls on the material; None if no wall was touched."""
    charts, said = _charts(source), _weight(source)
    if not charts and not said:
        return None
    body = pairs(said)
    body += charts_side_by_side({name: f"{of['title']} against time" for name, of in charts.items()})
    if charts:
        body += note(
            "The charts show force, torque and power of the walls on the material. Each value is the mean "
            "over the time between two rows of the history."
        )
    return Section("walls", "Forces of the walls", body, {"charts": charts})


def _charts(source: Source) -> dict[str, dict[str, Any]]:
    """A chart for each component of force, and for torque and power if they are not zero."""
    results = source.results
    if "wall_force" not in results.history or len(results.time) < 3:
        return {}
    charts = charts_of(results)
    if not charts:
        return {}
    largest = max(np.abs(of.values).max() for of in charts)
    charts = [of for of in charts if np.abs(of.values).max() > NEGLIGIBLE * largest]
    rows, (chosen, _) = rows_of(source), chosen_of(charts)
    names = [str(name) for name in results.history["wall"].values]
    found = {}
    for count, (label, values) in enumerate(charts):
        title, _, unit = label.rpartition(" (")
        whole = np.vstack([np.full((1, values.shape[1]), np.nan), values])[rows]
        curves = [
            {"label": _wall_name(names[wall], results.case), "values": listed(whole[:, wall])}
            for wall in chosen
            if np.abs(values[:, wall]).max() > NEGLIGIBLE * np.abs(values).max()
        ]
        if drawn := of_curves(source, f"Walls: {title}", unit.rstrip(")"), curves):
            found[f"wall-{count}"] = drawn
    return found


def _wall_name(name: str, case: dict[str, Any]) -> str:
    return f"wall {name}" if name in case.get("walls", {}) else f"face {name}"


def _weight(source: Source) -> list[tuple[str, str]]:
    """The weight of the material, and the vertical force of the walls at the end."""
    history, mass = source.results.history, source.results.series("total_mass")
    gravity = source.results.case.get("gravity") or [0.0, -STANDARD_GRAVITY]
    rows, upright = len(source.results.time), gravity[-1] < 0 and not any(gravity[:-1])
    upright &= not source.results.case.get("forces")
    if not upright or mass is None or "wall_force" not in history or rows < 3:
        return []
    vertical = history["wall_force"].values[..., -1].sum(axis=1)[-max(1, round(LAST * rows)) :]
    return [
        ("Weight", f"{number(-float(mass[-1]) * gravity[-1])} N"),
        (
            "Walls carry",
            f"{number(float(np.mean(vertical)))} N upwards, mean over the last tenth of the run; "
            "if the material is at rest, this equals the weight",
        ),
    ]
