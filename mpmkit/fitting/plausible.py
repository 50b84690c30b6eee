"""Checks of measurements: possible in this scene, in the right units, and without contradictions."""

from __future__ import annotations

import math

import numpy as np

from ..case.model import Case
from ..errors import CaseError
from ..output.summary import T500_DIAMETER
from .measurements import Measured
from .quantities import LENGTHS

MILLIMETRES = 1000.0
"""Factor between millimetres and metres, and between milliseconds and seconds."""
FAR_APART = 3.0
"""Two measurements contradict each other if they differ by more of their combined standard uncertainties."""
SPREADS = {"spread_diameter", "final_spread"}
SLUMPS = {"slump", "final_slump"}
HEIGHTS = {"height", "final_height", "axis_height"}


def check(test: str, case: Case, measured: list[Measured]) -> None:
    """Refuse measurements that no run of the case can give, and measurements that contradict each other.

    Raises:
        CaseError: one sentence with the measurement, its value and what is possible.
    """
    for one in measured:
        _units(case, one)
        _times(case, one)
        _possible(test, case, one)
    _agree(measured)


def _largest(case: Case) -> float:
    """The largest possible length of the material, m: that of the domain; spreads are diameters."""
    lower, upper = case.domain_bounds
    return float(max((upper - lower) * (2.0 if case.space == "axisymmetric" else 1.0)))


def _place(one: Measured) -> str:
    return one.where if one.is_curve else f"{one.where}.value"


def _units(case: Case, one: Measured) -> None:
    value = float(np.abs(one.value).max())
    length = one.quantity.variable in LENGTHS and not one.quantity.is_time
    largest = _largest(case)
    # Ten times the scene: lengths that are only a little too large get the message with the possible values.
    if length and value > 10 * largest and value / MILLIMETRES <= 10 * largest:
        raise CaseError(
            f"{_place(one)} is {value:g} m, and the scene is {largest:g} m wide; that looks like "
            f"millimetres: write {value / MILLIMETRES:g}"
        )
    if one.quantity.is_time and value > 20 * case.end:
        raise CaseError(
            f"{_place(one)} is {value:g} s, and the case ends at {case.end:g} s; if that is in "
            f"milliseconds, write {value / MILLIMETRES:g}"
        )
    if np.any(one.uncertainty > 10 * np.abs(one.value).max()) and length:
        raise CaseError(
            f"{one.where}: the uncertainty is {one.uncertainty.max():g} m of a value of {value:g} m; if "
            f"it is in millimetres, write {one.uncertainty.max() / MILLIMETRES:g}"
        )


def _times(case: Case, one: Measured) -> None:
    last = float(np.nanmax(one.time)) if np.isfinite(one.time).any() else 0.0
    if last > 50 * case.end:
        raise CaseError(
            f"{one.where}: the last time is {last:g} s, and the case ends at {case.end:g} s; that looks "
            f"like milliseconds: write {last / MILLIMETRES:g}"
        )
    if last > case.end * (1 + 1e-9):
        raise CaseError(
            f"{one.where}: the last time is {last:g} s, and the case ends at {case.end:g} s; raise "
            f"until in the case, or give last: {case.end:g}"
        )
    if one.quantity.is_time and one.value[0] > case.end:
        raise CaseError(
            f"{_place(one)} is {one.value[0]:g} s, and the case ends at {case.end:g} s; raise until in "
            "the case"
        )


def _possible(test: str, case: Case, one: Measured) -> None:
    if one.quantity.is_time:
        if one.value[0] <= 0:
            raise CaseError(f"{_place(one)} is {one.value[0]:g} s; it must be above 0")
        return
    bounds = [body.shape.bounds(case.space_) for body in case.bodies]
    tallest = max(float(upper[-1]) for _, upper in bounds) - min(float(lower[-1]) for lower, _ in bounds)
    variable, slack = one.quantity.variable, FAR_APART * one.uncertainty
    largest, least = float((one.value - slack).max()), float((one.value + slack).min())
    of = f"from a body of {tallest * MILLIMETRES:.0f} mm in test '{test}'"
    if variable in SLUMPS and largest >= tallest:
        raise CaseError(
            f"{_place(one)}: a slump of {one.value.max() * MILLIMETRES:.0f} mm is impossible {of}"
        )
    if variable in HEIGHTS and largest > tallest:
        raise CaseError(
            f"{_place(one)}: a height of {one.value.max() * MILLIMETRES:.0f} mm is impossible {of}"
        )
    if variable in (SLUMPS | HEIGHTS) and least < 0:
        raise CaseError(f"{_place(one)} is {one.value.min():g} m; it must be at least 0")
    if variable in SPREADS:
        first = _first_spread(case)
        if least < 0.98 * first:
            raise CaseError(
                f"{_place(one)} is {one.value.min():g} m; it must be at least the spread at the start, "
                f"{first:g} m"
            )
        if largest > _largest(case):
            raise CaseError(
                f"{_place(one)} is {one.value.max():g} m, and the domain of the case ends at a spread of "
                f"{_largest(case):g} m; enlarge grid.domain"
            )


def _first_spread(case: Case) -> float:
    """Diameter of the material before it moves, m; 0 with symmetry planes, where only the run can tell it."""
    ends = [body.shape.bounds(case.space_) for body in case.bodies]
    if case.space == "axisymmetric":
        return 2 * max(float(upper[0]) for _, upper in ends)
    if "symmetry" in case.grid.faces.values():
        return 0.0
    return max(float(upper[0]) for _, upper in ends) - min(float(lower[0]) for lower, _ in ends)


def _agree(measured: list[Measured]) -> None:
    """Refuse two numbers of one test that contradict each other."""
    for number, one in enumerate(measured):
        for other in measured[:number]:
            if one.quantity == other.quantity and not one.is_curve:
                _close(other, one, other.value[0], one.value[0], other.uncertainty[0], one.uncertainty[0])
    ends = [one for one in measured if one.quantity.variable == "final_spread"]
    for end in ends:
        for one in measured:
            if one.quantity.variable == "spread_diameter" and not one.quantity.is_time:
                at = int(np.argmax(one.value))
                if one.value[at] > end.value[0]:  # a spread shrinks only by elastic recoil
                    _close(one, end, one.value[at], end.value[0], one.uncertainty[at], end.uncertainty[0])
            if (
                one.quantity.variable == "t500"
                and end.value[0] + FAR_APART * end.uncertainty[0] < T500_DIAMETER
            ):
                raise CaseError(
                    f"{one.where} and {end.where} contradict each other: a T500 of {one.value[0]:g} s "
                    f"needs a spread of {T500_DIAMETER:g} m, and the final spread is {end.value[0]:g} m"
                )
    for time in (one for one in measured if one.quantity.variable == "t500"):
        for curve in measured:
            if curve.quantity.variable == "spread_diameter" and curve.is_curve:
                _t500_of(curve, time)


def _t500_of(curve: Measured, time: Measured) -> None:
    above = curve.value >= T500_DIAMETER
    if not above.any():
        return
    after = int(np.argmax(above))
    if after == 0:
        return
    at = float(
        np.interp(T500_DIAMETER, curve.value[after - 1 : after + 1], curve.time[after - 1 : after + 1])
    )
    rate = (curve.value[after] - curve.value[after - 1]) / (curve.time[after] - curve.time[after - 1])
    _close(curve, time, at, time.value[0], curve.uncertainty[after] / rate, time.uncertainty[0])


def _close(one: Measured, other: Measured, a: float, b: float, sa: float, sb: float) -> None:
    if abs(a - b) > FAR_APART * math.hypot(sa, sb):
        raise CaseError(
            f"{one.where} and {other.where} contradict each other: the {other.quantity.words} is {a:.4g} "
            f"{other.quantity.unit} by the one and {b:.4g} {other.quantity.unit} by the other, "
            f"{abs(a - b) / math.hypot(sa, sb):.1f} times their uncertainty apart"
        )
