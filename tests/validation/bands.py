"""Bands: the expected value of a number, the tolerance, and the part of the tolerance that is used.

The verdict in the validation report and the assertion of the test are the same comparison.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Band:
    """From ``low`` to ``high``, ends included."""

    low: float
    high: float
    expected: str
    text: str
    digits: int = 4
    """Significant digits in which an obtained number is worth reading."""

    def used(self, obtained: float) -> float:
        """How close to the edge of the band the number is: 1 on the edge, 0 far inside, infinite outside.

        It ranks runs that share a line of the report. A band with two ends: the distance from its middle over
        half of its width. A band with one end: the value falls with the distance from that end, to 1/2 where
        the distance is as large as the limit itself.
        """
        if not self.holds(obtained):
            return math.inf
        if math.isfinite(self.low) and math.isfinite(self.high):
            half = (self.high - self.low) / 2
            return abs(obtained - (self.low + self.high) / 2) / half if half > 0 else 0.0
        limit = self.high if math.isinf(self.low) else self.low
        return 1 / (1 + abs(obtained - limit) / (abs(limit) or 1.0))

    def holds(self, obtained: float) -> bool:
        return bool(self.low <= obtained <= self.high)

    def show(self, obtained: float) -> str:
        return number(obtained, self.digits)


def number(value: float, digits: int = 6) -> str:
    """As a table shows it."""
    return f"{value:.{digits}g}"


def close_to(expected: float, *, rel: float = 0.0, abs: float = 0.0) -> Band:
    """Expected ± the larger of ``rel`` times it and ``abs``."""
    by_rel = rel * math.fabs(expected)
    tolerance = max(by_rel, abs)
    text = f"± {number(100 * rel, 3)} %" if by_rel >= abs and rel >= 1e-3 else f"± {number(tolerance, 2)}"
    if by_rel >= abs and rel < 1e-3:
        text = f"± {number(rel, 2)} relative"
    resolved = math.log10(math.fabs(expected) / tolerance) if expected and tolerance else 2.0
    digits = min(max(math.ceil(resolved) + 2, 3), 9)
    return Band(expected - tolerance, expected + tolerance, number(expected, max(digits, 6)), text, digits)


def below(limit: float, expected: str | None = None) -> Band:
    """At most this; ``expected`` says what it ideally is, if anything."""
    text = f"≤ {number(limit, 3)}"
    return Band(-math.inf, limit, expected or text, text, 3)


def above(limit: float, expected: str | None = None) -> Band:
    """At least this."""
    text = f"≥ {number(limit, 3)}"
    return Band(limit, math.inf, expected or text, text)


def between(low: float, high: float, expected: str | None = None) -> Band:
    """From low to high."""
    text = f"{number(low)} to {number(high)}"
    return Band(low, high, expected or text, text)
