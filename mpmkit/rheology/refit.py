"""Another law for the same material: common parameters are kept, the others are fitted to the flow curve."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..contracts import ElastoviscoplasticLaw, GeneralisedNewtonianLaw, Plugin
from ..registry import Registry
from ..registry.blame import blaming_plugins
from .flow_curve import flow_curve

RATES = np.geomspace(0.1, 10.0, 41)
"""Shear rates, 1/s, at which the curves are fitted: those of a slump, and of rheometers for concrete."""
ITERATIONS = 60
FLUIDS = (GeneralisedNewtonianLaw, ElastoviscoplasticLaw)


def with_law(material: dict[str, Any], name: str, registry: Registry) -> tuple[dict[str, Any], list[str]]:
    """The material with the law ``name``, and what was fitted, as sentences.

    Parameters that both laws have are kept. Required parameters that only the new law has are fitted to the
    stress in simple shear at ``RATES``, by least squares (Gauss-Newton iteration in the logarithms of the
    parameters). If one of the two laws has no flow curve, nothing is fitted.

    Args:
        material: the material of a case file, with its law and parameters.
        name: of the new law.
        registry: contains both laws.

    Raises:
        PluginStop: one of the two laws is at fault.
    """
    laws = registry.of_kind("law")
    old, new = laws.get(material.get("law", "")), laws.get(name)
    if old is None or new is None or old is new:
        return material | {"law": name}, []
    with blaming_plugins([("law", old), ("law", new)]):
        return _refitted(material, old, new)


def _refitted(
    material: dict[str, Any], old: type[Plugin], new: type[Plugin]
) -> tuple[dict[str, Any], list[str]]:
    name = new.name
    own = set(old.model_fields) - set(new.model_fields)
    kept = {key: value for key, value in material.items() if key not in own} | {"law": name}
    missing = [key for key, field in new.model_fields.items() if field.is_required() and key not in kept]
    shared = {key: kept[key] for key in new.model_fields if key in kept}
    try:
        before = old.model_validate({k: material[k] for k in old.model_fields if k in material})
    except ValueError:  # the check of the case will report it
        return kept, []
    target = flow_curve(before, RATES)
    if not missing or target is None or not issubclass(new, FLUIDS):
        return kept, []
    fitted = _fit(new, shared, missing, target)
    values = ", ".join(f"{key} = {value:.4g}" for key, value in fitted.items())
    return kept | fitted, [
        f"law '{name}' with {values}, fitted to the flow curve of '{old.name}' from {RATES[0]:g} to "
        f"{RATES[-1]:g} /s"
    ]


def _fit(
    law: type[Plugin], shared: dict[str, Any], missing: list[str], target: np.ndarray
) -> dict[str, float]:
    def curve(logarithms: np.ndarray) -> Any:
        at_values = shared | dict(zip(missing, np.exp(logarithms), strict=True))
        return flow_curve(law.model_validate(at_values), RATES)

    at = np.zeros(len(missing))
    for _ in range(ITERATIONS):
        found = curve(at)
        slopes = np.stack([(curve(at + step) - found) / 1e-6 for step in 1e-6 * np.eye(len(missing))], axis=1)
        change = np.linalg.lstsq(slopes, target - found, rcond=None)[0]
        at = at + np.clip(change, -1.0, 1.0)  # a parameter changes by at most a factor e
        if np.abs(change).max() < 1e-12:
            break
    return {key: float(f"{value:.8g}") for key, value in zip(missing, np.exp(at), strict=True)}
