"""The case with everything filled in that it leaves to a default."""

from __future__ import annotations

from typing import Any

from .model import Case
from .output import FRAMES, ROWS


def resolved(case: Case) -> dict[str, Any]:
    """The case with everything filled in that it leaves to a default."""
    data = case.model_dump(mode="json")
    data["gravity"] = case.gravity_vector.tolist()
    data["output"]["history_interval"] = case.output.history_interval or case.until / ROWS
    data["output"]["frame_interval"] = case.output.frame_interval or case.until / FRAMES
    for body, entry in zip(case.bodies, data["bodies"], strict=True):
        entry["particles_per_cell"] = list(body.particles_along_axes(case.space_.dim))
        if entry["shape"].get("base", ...) is None:
            entry["shape"]["base"] = [0.0] * case.space_.dim
        entry["velocity"] = entry["velocity"] or [0.0] * case.space_.dim
    return data
