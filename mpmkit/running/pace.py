"""The wall time that a run still needs, estimated from its recent pace."""

from __future__ import annotations

import statistics
from collections import deque

RECENT = 15
"""Intervals that are kept."""
FEWEST = 3
"""Intervals before an estimate is given: kernels are compiled in the first steps."""


class Pace:
    """Wall seconds per simulated second of the last intervals.

    The estimate uses the median of the intervals. So a few slow ones, in which kernels are compiled or files
    are written, do not change it.
    """

    def __init__(self) -> None:
        self._last: tuple[float, float] | None = None
        self._paces: deque[float] = deque(maxlen=RECENT)

    def note(self, wall: float, time: float) -> None:
        """Note the wall time, s, at a simulated time, s."""
        if self._last is not None and time > self._last[1]:
            self._paces.append((wall - self._last[0]) / (time - self._last[1]))
        self._last = wall, time

    @property
    def known(self) -> bool:
        """Whether there are enough intervals for an estimate."""
        return len(self._paces) >= FEWEST

    def left(self, remaining: float) -> float:
        """Wall time, s, for the rest of the simulated time, s; 0 if nothing is known."""
        return statistics.median(self._paces) * remaining if self._paces else 0.0
