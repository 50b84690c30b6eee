"""Start of a search: a closed-form solution of the test if there is one, else the middle of the bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..case.model import Case
from .coordinates import Coordinates
from .runs import Test

EDGE = 0.05
"""Least distance of a first guess from the bounds, as part of the box."""


def first_guess(coordinates: Coordinates, tests: Sequence[Test]) -> tuple[np.ndarray, list[str]]:
    """Initial coordinates, and sentences about the closed-form solutions that gave them."""
    guess, said = np.full(len(coordinates), 0.5), []
    for index, (path, parameter) in enumerate(zip(coordinates.paths, coordinates.parameters, strict=True)):
        if parameter.start is not None:
            guess[index] = coordinates.coordinate(index, parameter.start)
            continue
        if parameter.prior is not None:
            guess[index] = np.clip(coordinates.coordinate(index, parameter.prior.value), EDGE, 1 - EDGE)
            continue
        if not path.endswith(".yield_stress"):
            continue
        for test in tests:
            found = yield_stress_of_spread(test.stages[-1].case, _final_spread(test))
            if found is not None:
                stress, source = found
                guess[index] = np.clip(coordinates.coordinate(index, stress), EDGE, 1 - EDGE)
                said.append(f"The search for {path} starts at {stress:.3g} Pa, {source}.")
                break
    return guess, said


def _final_spread(test: Test) -> float | None:
    """The largest spread that was measured in a test, m; None if none was."""
    spreads = [
        float(one.value.max())
        for one in test.measured
        if one.quantity.variable in ("final_spread", "spread_diameter") and not one.quantity.is_time
    ]
    return max(spreads) if spreads else None


def yield_stress_of_spread(case: Case, diameter: float | None) -> tuple[float, str] | None:
    """Yield stress, Pa, of one body at rest with this spread, and the formula; None if none applies.

    Roussel & Coussot, J. Rheol. 49 (2005) 705: tau0 = 225 ρ g V²/(128 π² R⁵) on a floor without slip. On a
    floor with free slip, a sheet of uniform thickness: tau0 = ρ g V/(2 √3 π R²) (docs/accuracy.md).
    """
    if diameter is None or diameter <= 0 or len(case.bodies) != 1 or case.space == "plane-strain":
        return None
    body, radius = case.bodies[0], diameter / 2
    volume = body.shape.volume(case.space_)
    weight = body.material.density * float(np.linalg.norm(case.gravity_at_start)) * volume
    face = case.grid.faces.get(f"{case.space_.axes[-1]}_min")
    floor = getattr(face, "kind", face)
    if floor == "stick":
        return 225 * weight * volume / (128 * math.pi**2 * radius**5), "by Roussel and Coussot's formula"
    if floor == "slip":
        return weight / (2 * math.sqrt(3) * math.pi * radius**2), "by the formula for a flat sheet, free slip"
    return None
