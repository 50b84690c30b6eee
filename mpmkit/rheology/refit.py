"""Another law for the same material: what both have is kept, the rest is fitted to the flow curve."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..contracts import ElastoviscoplasticLaw, GeneralisedNewtonianLaw, Plugin
from ..registry import Registry
from ..registry.audit import require_array, require_number
from ..registry.blame import blaming_plugins

RATES = np.geomspace(0.1, 10.0, 41)
"""Shear rates, 1/s, over which the curves are to agree: those of a slump, and of rheometers for concrete."""
ITERATIONS = 60
FLUIDS = (GeneralisedNewtonianLaw, ElastoviscoplasticLaw)


def with_law(material: dict[str, Any], name: str, registry: Registry) -> tuple[dict[str, Any], list[str]]:
    """The material with the law ``name``, and what was fitted, as sentences.

    Parameters that both laws have are kept. Those that the new one has alone, and needs, are chosen so that
    the stress in simple shear agrees in the least squares over ``RATES``, by Gauss and Newton in the
    logarithms of the parameters. Where one of the two has no flow curve, nothing is fitted.

    Args:
        material: of a case file, its law named and its parameters given.
        name: of the new law.
        registry: where both are found.

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
    except ValueError:  # the case will be refused, in words of its own
        return kept, []
    target = flow_curve(before)
    if not missing or target is None or not issubclass(new, FLUIDS):
        return kept, []
    fitted = _fit(new, shared, missing, target)
    values = ", ".join(f"{key} = {value:.4g}" for key, value in fitted.items())
    return kept | fitted, [
        f"law '{name}' with {values}, fitted to the flow curve of '{old.name}' from {RATES[0]:g} to "
        f"{RATES[-1]:g} /s"
    ]


def flow_curve(law: Any, rates: np.ndarray = RATES) -> np.ndarray | None:
    """Stress, Pa, in simple shear at ``rates``, 1/s; None of a law that is no fluid of the short "
    "contracts."""
    if isinstance(law, GeneralisedNewtonianLaw):
        viscosity = law.apparent_viscosity(rates.copy())
        require_array(law, "apparent_viscosity", viscosity, rates.shape)
        return viscosity * rates
    if isinstance(law, ElastoviscoplasticLaw):
        stress = law.flow_curve(rates.copy())
        if np.ndim(stress) == 0:  # a constant will do
            return np.full(rates.shape, require_number(law, "flow_curve", stress))
        require_array(law, "flow_curve", stress, rates.shape)
        return stress
    return None


def _fit(
    law: type[Plugin], shared: dict[str, Any], missing: list[str], target: np.ndarray
) -> dict[str, float]:
    def curve(logarithms: np.ndarray) -> Any:
        return flow_curve(law.model_validate(shared | dict(zip(missing, np.exp(logarithms), strict=True))))

    at = np.zeros(len(missing))
    for _ in range(ITERATIONS):
        found = curve(at)
        slopes = np.stack([(curve(at + step) - found) / 1e-6 for step in 1e-6 * np.eye(len(missing))], axis=1)
        change = np.linalg.lstsq(slopes, target - found, rcond=None)[0]
        at = at + np.clip(change, -1.0, 1.0)  # a parameter changes by a factor e at the most
        if np.abs(change).max() < 1e-12:
            break
    return {key: float(f"{value:.8g}") for key, value in zip(missing, np.exp(at), strict=True)}
