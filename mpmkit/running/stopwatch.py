"""The wall time of a run."""

from __future__ import annotations

import time as clock


class Stopwatch:
    """Wall time of a run from its first step on, s: what it takes to load and compile is not the run's.

    Args:
        before: what a run that goes on has taken up to its checkpoint.
    """

    def __init__(self, before: float = 0.0) -> None:
        self._before = before
        self._begin: float | None = None

    def start(self) -> None:
        self._begin = clock.monotonic()

    @property
    def elapsed(self) -> float:
        return self._before + (0.0 if self._begin is None else clock.monotonic() - self._begin)
