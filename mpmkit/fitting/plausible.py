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
SHRUNK = 6.0
"""A spread shrinks if it falls by more of its combined standard uncertainties. The largest of hundreds of
rows with noise is a few of them above the truth."""
FAR_APART = 3.0
"""Two measurements contradict each other if they differ by more of their combined standard uncertainties."""
LEAST_UNCERTAINTY = 1e-6
"""Least uncertainty relative to the value: double precision and the noise of runs allow no less."""
NEVER_NEGATIVE = {
    "kinetic_energy",
    "strain_energy",
    "compressive_energy",
    "total_mass",
    "max_speed",
    "final_spread_rate",
    "fractured_fraction",
}
SPREADS = {"spread_diameter", "final_spread"}
SLUMPS = {"slump", "final_slump"}
HEIGHTS = {"height", "final_height", "axis_height"}


def check(test: str, case: Case, measured: list[Measured]) -> None:
    """Refuse measurements that no run of the case can give, and measurements that contradict each other.

    Raises:
        CaseError: one sentence with the measurement, its value and what is possible.
    """
    for one in measured:
        _uncertain(one)
        _units(case, one)
        _times(case, one)
        _possible(test, case, one)
    _agree(measured, _tallest(case))


def _tallest(case: Case) -> float:
    """Height of the material at the start, m."""
    bounds = [body.shape.bounds(case.space_) for body in case.bodies]
    return max(float(upper[-1]) for _, upper in bounds) - min(float(lower[-1]) for lower, _ in bounds)


def _largest(case: Case) -> float:
    """The largest possible length of the material, m: that of the domain; spreads are diameters."""
    lower, upper = case.domain_bounds
    return float(max((upper - lower) * (2.0 if case.space == "axisymmetric" else 1.0)))


def _place(one: Measured) -> str:
    return one.where if one.is_curve else f"{one.where}.value"


def _uncertain(one: Measured) -> None:
    part = one.uncertainty / np.maximum(np.abs(one.value), 1e-300)
    worst = int(np.argmin(part))
    if part[worst] < LEAST_UNCERTAINTY:
        raise CaseError(
            f"{one.where}: the uncertainty is {one.uncertainty[worst]:g} {one.quantity.unit} of a value of "
            f"{one.value[worst]:g} {one.quantity.unit}; it must be at least {LEAST_UNCERTAINTY:g} of "
            "the value"
        )


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
    if one.quantity.unit == "s" and value > 20 * case.end:
        raise CaseError(
            f"{_place(one)} is {value:g} s, and the case ends at {case.end:g} s; if that is in "
            f"milliseconds, write {value / MILLIMETRES:g}"
        )
    if np.any(one.uncertainty > 10 * value) and value > 0 and length:
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
    if one.quantity.unit == "s" and one.value[0] > case.end:
        raise CaseError(
            f"{_place(one)} is {one.value[0]:g} s, and the case ends at {case.end:g} s; raise until in "
            "the case"
        )


def _possible(test: str, case: Case, one: Measured) -> None:
    if one.quantity.unit == "s" and one.value[0] <= 0:
        raise CaseError(f"{_place(one)} is {one.value[0]:g} s; it must be above 0")
    if one.quantity.is_time:
        _reachable(case, one)
        return
    if one.quantity.variable in NEVER_NEGATIVE and one.value.min() < 0:
        raise CaseError(f"{_place(one)} is {one.value.min():g} {one.quantity.unit}; it must be at least 0")
    tallest = _tallest(case)
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
    if variable in SLUMPS and least < 0:
        raise CaseError(f"{_place(one)} is {one.value.min():g} m; it must be at least 0")
    if variable in HEIGHTS and one.value.min() <= 0:
        raise CaseError(f"{_place(one)} is {one.value.min():g} m; it must be above 0")
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


def _reachable(case: Case, one: Measured) -> None:
    """Refuse a level of the spread that no run reaches, or that it has at the start."""
    level = one.quantity.reaches
    if one.quantity.variable != "spread_diameter" or level is None:
        return
    first = _first_spread(case)
    if level <= first:
        raise CaseError(
            f"{one.where}.reaches is {level:g} m; it must be above the spread at the start, {first:g} m"
        )
    if level > _largest(case):
        raise CaseError(
            f"{one.where}.reaches is {level:g} m, and the domain of the case ends at a spread of "
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


def _agree(measured: list[Measured], tallest: float) -> None:
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
    _curves_agree(measured)
    _spreads_grow(measured)
    _slump_and_height(measured, tallest)


def _spreads_grow(measured: list[Measured]) -> None:
    """Refuse spreads that shrink: concrete does not flow back. A T500 is a spread of 500 mm at its time."""
    rows = [
        (float(t), float(d), float(s), one)
        for one in measured
        if one.quantity.variable == "spread_diameter" and not one.quantity.is_time
        for t, d, s in zip(one.time, one.value, one.uncertainty, strict=True)
    ]
    for one in measured:
        if one.quantity.variable == "t500":
            t, slack = float(one.value[0]), FAR_APART * float(one.uncertainty[0])
            for at, d, s, other in rows:
                late, early = at > t + slack, at < t - slack
                if not other.is_curve and (
                    (late and d + FAR_APART * s < T500_DIAMETER)
                    or (early and d - FAR_APART * s > T500_DIAMETER)
                ):
                    raise CaseError(
                        f"{other.where} and {one.where} contradict each other: the spread is {d:g} m "
                        f"at {at:g} s, and it reaches {T500_DIAMETER:g} m at {t:g} s"
                    )
    largest = None
    for row in sorted(rows, key=lambda row: row[0]):
        if largest is not None and largest[1] - row[1] > SHRUNK * math.hypot(largest[2], row[2]):
            places = dict.fromkeys([largest[3].where, row[3].where])
            does = "contradicts itself" if len(places) == 1 else "contradict each other"
            raise CaseError(
                f"{' and '.join(places)} {does}: the spread is {largest[1]:.4g} m at {largest[0]:g} s and "
                f"{row[1]:.4g} m at {row[0]:g} s, but a spread does not shrink"
            )
        if largest is None or row[1] > largest[1]:
            largest = row


def _curves_agree(measured: list[Measured]) -> None:
    """Refuse two curves of one quantity that differ by more than their uncertainties."""
    curves = [one for one in measured if one.is_curve]
    for number, one in enumerate(curves):
        for other in curves[:number]:
            common = (one.time >= other.time[0]) & (one.time <= other.time[-1])
            same = (one.quantity.variable, one.quantity.of) == (other.quantity.variable, other.quantity.of)
            if not same or not common.any():
                continue
            value, deviation = (
                np.interp(one.time[common], other.time, y) for y in (other.value, other.uncertainty)
            )
            apart = np.abs(one.value[common] - value) / np.hypot(one.uncertainty[common], deviation)
            if math.sqrt(float(np.mean(apart**2))) > FAR_APART:
                worst = int(np.argmax(apart))
                unit = one.quantity.unit
                raise CaseError(
                    f"{other.where} and {one.where} contradict each other: the {one.quantity.words} is "
                    f"{value[worst]:.4g} {unit} by the one and {one.value[common][worst]:.4g} {unit} by the "
                    f"other at {one.time[common][worst]:g} s, "
                    f"{apart[worst]:.1f} times their uncertainty apart"
                )


def _slump_and_height(measured: list[Measured], tallest: float) -> None:
    """Refuse a slump and a height that do not add up to the height at the start."""
    for slump in (one for one in measured if one.quantity.variable == "final_slump"):
        for height in (one for one in measured if one.quantity.variable == "final_height"):
            total = float(slump.value[0] + height.value[0])
            slack = FAR_APART * math.hypot(slump.uncertainty[0], height.uncertainty[0])
            if total < tallest - slack:  # the largest height may be beside the axis, and be more
                raise CaseError(
                    f"{slump.where} and {height.where} contradict each other: slump and height add up to "
                    f"{total:.4g} m, and the body is {tallest:g} m tall at the start"
                )


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
