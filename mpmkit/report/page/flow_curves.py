"""Section: the flow curve of each material, and the range of shear rates that the run reached."""

from __future__ import annotations

import math
from html import escape
from typing import Any

import numpy as np

from ...case.material import Material
from ...contracts import Plugin
from ...errors import GuardStop
from ...registry.blame import blaming_plugins
from ...rheology.flow_curve import flow_curve
from .histories import listed
from .section import Section, chart_place, note, pairs
from .source import Source
from .words import given, number, unit_of

POINTS = 121
DECADES = (1e-3, 1e3)
"""Shear rates, 1/s, of the curve of a material that has not been sheared."""
BEYOND = 10.0
"""The curve extends beyond the reached shear rates by this factor."""
MOST, LEAST = 0.95, 0.05
"""The shaded range lies between these quantiles of the sheared material."""
SLOWEST = 1e-3
"""Material with less than this part of the largest shear rate counts as at rest."""


def section(source: Source) -> Section | None:
    """A chart for each material that is a fluid, and the parameters of all."""
    if source.case is None:
        body = note(
            "The flow curves cannot be drawn here: the case names a plug-in that is not installed, or its "
            "file cannot be read."
        )
        return Section("materials", "Materials", body)
    body, charts = "", {}
    for count, (material, bodies) in enumerate(_materials(source)):
        name, law = f"material-{count}", material.constitutive_law
        reached = _reached(source, bodies)
        curve = _chart(law, reached)
        body += f"<h3>{escape(law.name)}</h3>" + pairs(_parameters(material))
        if curve is None:
            body += note("This law has no flow curve.")
            continue
        charts[name] = curve
        body += chart_place(name, "Shear stress against shear rate") + note(_words(reached))
    return Section("materials", "Materials", body, {"charts": charts})


def _materials(source: Source) -> list[tuple[Material, list[int]]]:
    """Each material once, with the numbers of its bodies; sources have the numbers after the bodies."""
    assert source.case is not None
    found: list[tuple[Material, list[int]]] = []
    case = source.case
    given = [of.material for of in case.bodies] + [of.material for of in case.sources.values()]
    for number_, of_one in enumerate(given):
        for material, bodies in found:
            if material == of_one:
                bodies.append(number_)
                break
        else:
            found.append((of_one, [number_]))
    return found


def _parameters(material: Material) -> list[tuple[str, str]]:
    found = [("Density", f"{given(material.density)} kg/m³")]
    law = material.constitutive_law
    for key, field in type(law).model_fields.items():
        value = getattr(law, key)
        if value is None:
            continue
        extra = field.json_schema_extra
        unit = str(extra.get("unit", "")) if isinstance(extra, dict) else ""
        shown = given(value) if isinstance(value, int | float) and not isinstance(value, bool) else value
        found.append((key.replace("_", " ").capitalize(), f"{shown} {unit_of(unit)}".rstrip()))
    return found


def _reached(source: Source, bodies: list[int]) -> tuple[float, float, float] | None:
    """Shear rates, 1/s, between which most of the sheared material was, and the largest."""
    rates: list[np.ndarray] = []
    weights: list[np.ndarray] = []
    times = [moment.time for moment in source.moments]
    passed = np.gradient(times) if len(times) > 1 else np.ones(len(times))
    for moment, weight in zip(source.moments, passed, strict=True):
        of = np.isin(moment.body, bodies)
        size = moment.half_size[of].astype(float)
        volume = size.prod(axis=1) * (moment.position[of, 0] if source.space.radial else 1.0)
        rates.append(moment.shear_rate[of].astype(float))
        weights.append(volume * weight / moment.share)
    if not rates:
        return None
    rate, shares = np.concatenate(rates), np.concatenate(weights)
    largest = float(rate.max(initial=0.0))
    sheared = (rate > SLOWEST * largest) & (shares > 0)
    if not sheared.any():
        return None
    order = np.argsort(rate[sheared])
    summed = np.cumsum(shares[sheared][order])
    low, high = np.interp([LEAST, MOST], summed / summed[-1], rate[sheared][order])
    return float(low), float(high), largest


def _chart(law: Plugin, reached: tuple[float, float, float] | None) -> dict[str, Any] | None:
    """Stress against shear rate on logarithmic axes, with the range that the run has reached."""
    low, high = DECADES if reached is None else (reached[0] / BEYOND, reached[2] * BEYOND)
    rates = np.geomspace(10 ** math.floor(math.log10(low)), 10 ** math.ceil(math.log10(high)), POINTS)
    try:
        with blaming_plugins([("law", law)]):
            stress = flow_curve(law, rates)
    except GuardStop:  # the rest of the page can still be made
        return None
    if stress is None or not np.isfinite(stress).all() or not (stress > 0).any():
        return None
    curve = {"label": "shear stress", "values": listed(np.where(stress > 0, stress, np.nan))}
    return {
        "title": "Flow curve: shear stress against shear rate",
        "unit": "Pa",
        "x": listed(rates),
        "xLabel": "shear rate",
        "xUnit": "1/s",
        "curves": [curve],
        "logarithmic": True,
        "band": None if reached is None else {"from": reached[0], "to": reached[1], "most": reached[2]},
    }


def _words(reached: tuple[float, float, float] | None) -> str:
    if reached is None:
        return "The material was not sheared in this run."
    low, high, largest = reached
    return (
        f"90 % of the sheared material had shear rates between {number(low, 2)} and "
        f"{number(high, 2)} 1/s (shaded); the largest was {number(largest, 2)} 1/s. Measure the material in "
        "that range: outside it, the flow curve has almost no influence on this result."
    )
