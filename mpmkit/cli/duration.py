"""Lengths of time as people write them."""

from __future__ import annotations

import math
import re
from typing import Any

import click

YEAR = 365.25 * 86400
"""s"""


def duration(seconds: float) -> str:
    """Minutes and seconds, 1:05; with hours, 2:01:05; with days before them; or years, if longer than one."""
    if not seconds < YEAR:
        return f"{seconds / YEAR:.3g} years" if math.isfinite(seconds) else "for ever"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    days, hours = divmod(hours, 24)
    if days:
        return f"{days} day{'s' * (days > 1)}, {hours}:{minutes:02d}:{rest:02d}"
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


UNITS = {"": 1.0, "s": 1.0, "min": 60.0, "h": 3600.0}


class Seconds(click.ParamType):
    """A length of time as an option: 60s, 10min, 1.5h, or a number of seconds."""

    name = "time"

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> float:
        if isinstance(value, float):
            return value
        found = re.fullmatch(r"(\d+(?:\.\d*)?|\.\d+)\s*(s|min|h)?", str(value).strip())
        if found is None or float(found[1]) <= 0:
            self.fail(f"{value} must be a time above zero, such as 60s, 10min or 1h", parameter, context)
        return float(found[1]) * UNITS[found[2] or ""]


SECONDS = Seconds()
