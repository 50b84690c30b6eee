"""Times of an action: multiples of an interval, and a list of times."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable

import numpy as np

AT_THE_END = 1 - 1e-9
"""A time after this part of the run counts as its end."""


class Schedule:
    """Times of an action, s, in order, from 0 to before ``until``; the end is not included."""

    def __init__(self, interval: float, until: float, extra: Iterable[float] = ()) -> None:
        regular = (k * interval for k in range(int(until / interval) + 1))
        self._times = sorted({t for t in (*regular, *extra) if t < until * AT_THE_END})
        self._next = 0

    def state(self) -> dict[str, np.ndarray]:
        """The last time that has passed; it is also valid in the schedule of a longer run."""
        return {"last": np.array(self._times[self._next - 1] if self._next else -math.inf)}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore it; the times after it are still due."""
        self._next = bisect_right(self._times, float(state["last"]))

    def passed(self, now: float) -> bool:
        """Whether a time was reached since the last call."""
        before = self._next
        while self._next < len(self._times) and self._times[self._next] <= now:
            self._next += 1
        return self._next > before
