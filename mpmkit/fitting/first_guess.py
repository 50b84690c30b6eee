"""Where a search begins: a closed form of the test where there is one, else the middle of the bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..case.model import Case
from .coordinates import Coordinates
from .runs import Test

EDGE = 0.05
"""A guess keeps this part of the box from its bounds."""


def first_guess(coordinates: Coordinates, tests: Sequence[Test]) -> tuple[np.ndarray, list[str]]:
    """Coordinates to begin with, and sentences about the closed forms that gave them."""
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
                said.append(f"The search for {path} begins at {stress:.3g} Pa, {source}.")
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
    """Yield stress, Pa, of one body at rest with this spread, and the formula; None where there is none.

    Roussel & Coussot, J. Rheol. 49 (2005) 705: tau0 = 225 ρ g V²/(128 π² R⁵) where the floor holds it. On a
    floor of free slip a sheet of even thickness tau0 = ρ g V/(2 √3 π R²) (docs/accuracy.md).
    """
    if diameter is None or diameter <= 0 or len(case.bodies) != 1 or case.space == "plane-strain":
        return None
    body, radius = case.bodies[0], diameter / 2
    volume = body.shape.volume(case.space_)
    weight = body.material.density * float(np.linalg.norm(case.gravity_vector)) * volume
    face = case.grid.faces.get(f"{case.space_.axes[-1]}_min")
    floor = getattr(face, "kind", face)
    if floor == "stick":
        return 225 * weight * volume / (128 * math.pi**2 * radius**5), "by Roussel and Coussot's spread"
    if floor == "slip":
        return weight / (2 * math.sqrt(3) * math.pi * radius**2), "by an even sheet at rest on free slip"
    return None
