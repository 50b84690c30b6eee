"""The case with everything filled in that it leaves to a default."""

from __future__ import annotations

from typing import Any

from .model import Case
from .output import FRAMES, ROWS


def resolved(case: Case) -> dict[str, Any]:
    """The case with everything filled in that it leaves to a default."""
    data = case.model_dump(mode="json")
    data["gravity"] = case.gravity_of_key.tolist()
    data["output"]["history_interval"] = case.output.history_interval or case.end / ROWS
    data["output"]["frame_interval"] = case.output.frame_interval or case.end / FRAMES
    for wall in data["walls"].values():
        _fill_base(wall["surface"].get("shape"), case)
    for body, entry in zip(case.bodies, data["bodies"], strict=True):
        entry["particles_per_cell"] = list(body.particles_along_axes(case.space_.dim))
        _fill_base(entry["shape"], case)
        if "velocity" not in body.initial:
            entry["velocity"] = entry["velocity"] or [0.0] * case.space_.dim
    for inflow, entry in zip(case.sources.values(), data["sources"].values(), strict=True):
        entry["particles_per_cell"] = list(inflow.particles_along_axes(case.space_.dim))
    return data


def _fill_base(shape: Any, case: Case) -> None:
    """The place of an upright shape that has none."""
    if isinstance(shape, dict) and shape.get("base", ...) is None:
        shape["base"] = [0.0] * case.space_.dim
