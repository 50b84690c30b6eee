"""Section: what the measurements, diagnostics, sources and sinks of the case recorded."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import xarray

from ...output.columns import COLUMNS
from .histories import listed, of_curves, rows_of
from .section import Section, charts, table
from .source import Source
from .words import number, unit_of

OWN = {column.name for column in COLUMNS}
"""Scalars of every history; other sections show them."""
PASSED = {
    "source_mass": "mass brought in",
    "source_rate": "rate",
    "sink_mass": "mass taken out",
    "sink_rate": "rate",
}
"""Columns with an entry for each source or sink, and what they are."""


class Curve(NamedTuple):
    """A number against time."""

    group: str
    """Curves of one group and one unit share a chart."""
    label: str
    unit: str
    meaning: str
    values: np.ndarray


def section(source: Source) -> Section | None:
    """A chart of each group and unit, and the last values; None if the case measures nothing of its own."""
    curves = [curve for curve in _curves(source) if np.isfinite(curve.values).any()]
    if not curves:
        return None
    found: dict[str, dict[str, Any]] = {}
    for group, unit in dict.fromkeys((curve.group, curve.unit) for curve in curves):
        of = [curve for curve in curves if (curve.group, curve.unit) == (group, unit)]
        drawn = [{"label": curve.label, "values": listed(curve.values[rows_of(source)])} for curve in of]
        title = of[0].meaning if len(of) == 1 else group
        chart = of_curves(source, f"{title[:1].upper()}{title[1:]}", unit, drawn)
        if chart is not None:
            found[f"measured-{len(found)}"] = chart
    body = charts({name: f"{of['title']} against time" for name, of in found.items()})
    rows = [(curve.label, curve.meaning, _last(curve)) for curve in curves]
    body += table(("name", "what it is", "at the end"), rows, "Last values")
    return Section("measured", "Measurements", body, {"charts": found})


def _last(curve: Curve) -> str:
    return f"{number(float(curve.values[-1]), 4)} {curve.unit}".rstrip()


def _curves(source: Source) -> Iterator[Curve]:
    history = source.results.history
    for key, variable in history.data_vars.items():
        name = str(key)
        unit, meaning = unit_of(variable.attrs.get("units", "1")), str(variable.attrs.get("long_name", name))
        if name in PASSED:
            kind = name.partition("_")[0]
            for one in variable[kind].values:
                values = _finite(variable.sel({kind: one}))
                yield Curve(f"{PASSED[name]}, by {kind}", str(one), unit, f"{meaning}: {one}", values)
        elif variable.dims == ("time",) and name not in OWN:
            group = name.partition(".")[0] if "." in name else "measurements of the case"
            yield Curve(group, name, unit, meaning, _finite(variable))


def _finite(variable: xarray.DataArray) -> np.ndarray:
    values = variable.values
    return np.where(np.isfinite(values), values, np.nan)
