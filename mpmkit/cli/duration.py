"""A length of time as a person says it."""

from __future__ import annotations

import math

YEAR = 365.25 * 86400
"""s"""


def duration(seconds: float) -> str:
    """Minutes and seconds, 1:05, hours, 2:01:05, or days before them; from a year on, years."""
    if not seconds < YEAR:
        return f"{seconds / YEAR:.3g} years" if math.isfinite(seconds) else "for ever"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    days, hours = divmod(hours, 24)
    if days:
        return f"{days} day{'s' * (days > 1)}, {hours}:{minutes:02d}:{rest:02d}"
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
