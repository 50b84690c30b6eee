"""Numbers as text: with a useful number of digits, and the unit."""

from __future__ import annotations

import math

MINUTE, HOUR = 60.0, 3600.0


def number(value: float, digits: int = 3) -> str:
    """A number with about ``digits`` digits; with an exponent only if it is very large or very small."""
    if not math.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if -4 <= size < 7:
        text = f"{value:,.{max(0, digits - 1 - size)}f}".replace(",", "\u202f")
    else:
        text = f"{value:.{digits - 1}e}"
    return text.replace("-", "−")


def count(value: float) -> str:
    """A whole number, with a narrow space between thousands."""
    return f"{value:,.0f}".replace(",", "\u202f")


def given(value: float) -> str:
    """A number as it was given."""
    return f"{value:.6g}"


def in_signs(unit: str) -> str:
    """A unit with raised exponents, such as kg/m³."""
    for power, sign in (("^2", "²"), ("^3", "³"), ("^n", "ⁿ")):
        unit = unit.replace(power, sign)
    return unit


def unit_of(unit: str) -> str:
    """A unit for a reader; a plain number has none."""
    return "" if unit == "1" else in_signs(unit)


def length(metres: float) -> str:
    """A length in mm, or in m where it is large."""
    return f"{number(metres)} m" if abs(metres) >= 10 else f"{number(1e3 * metres)} mm"


def seconds(value: float) -> str:
    """A time; a short one in ms or µs."""
    if value != 0 and abs(value) < 1e-3:
        return f"{number(1e6 * value)} µs"
    return f"{number(1e3 * value)} ms" if value != 0 and abs(value) < 0.1 else f"{number(value)} s"


def duration(value: float) -> str:
    """A wall time."""
    if value < 2 * MINUTE:
        return f"{number(value, 2)} s"
    if value < 2 * HOUR:
        return f"{value / MINUTE:.0f} min"
    return f"{value / HOUR:.1f} h"


def percent(part: float) -> str:
    return f"{number(100 * part, 2)} %"
