"""When something is due: at multiples of an interval, and at a list of times."""

from __future__ import annotations

from collections.abc import Iterable

ROUNDING = 1 + 1e-12
"""A multiple of the interval that misses the end by rounding is still within it."""


class Schedule:
    """Times that are waited for, in order, from 0 to ``until``, s."""

    def __init__(self, interval: float, until: float, extra: Iterable[float] = ()) -> None:
        regular = (k * interval for k in range(int(until / interval * ROUNDING) + 1))
        self._times = sorted({t for t in (*regular, *extra) if t <= until * ROUNDING})
        self._next = 0

    def passed(self, now: float) -> bool:
        """Whether a time has come since the last call."""
        before = self._next
        while self._next < len(self._times) and self._times[self._next] <= now:
            self._next += 1
        return self._next > before
