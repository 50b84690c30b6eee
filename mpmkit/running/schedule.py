"""When something is due: at multiples of an interval, and at a list of times."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable

import numpy as np

AT_THE_END = 1 - 1e-9
"""Part of the run after which a time counts as its end."""


class Schedule:
    """Times that are waited for, in order, from 0 to before ``until``, s; the end needs no waiting for."""

    def __init__(self, interval: float, until: float, extra: Iterable[float] = ()) -> None:
        regular = (k * interval for k in range(int(until / interval) + 1))
        self._times = sorted({t for t in (*regular, *extra) if t < until * AT_THE_END})
        self._next = 0

    def state(self) -> dict[str, np.ndarray]:
        """The last time that has passed, which means the same in the schedule of a longer run."""
        return {"last": np.array(self._times[self._next - 1] if self._next else -math.inf)}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Take it back; the times after it are still waited for."""
        self._next = bisect_right(self._times, float(state["last"]))

    def passed(self, now: float) -> bool:
        """Whether a time has come since the last call."""
        before = self._next
        while self._next < len(self._times) and self._times[self._next] <= now:
            self._next += 1
        return self._next > before
