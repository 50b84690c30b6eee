"""The wall time of a run."""

from __future__ import annotations

import time as clock

import numpy as np


class Stopwatch:
    """Wall time of a run from its first step, s; loading and compiling are not included."""

    def __init__(self) -> None:
        self._before = 0.0
        """wall time up to the checkpoint, for a continued run"""
        self._begin: float | None = None

    def state(self) -> dict[str, np.ndarray]:
        """The time so far."""
        return {"elapsed": np.array(self.elapsed)}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Continue the clock from its saved time."""
        self._before, self._begin = float(state["elapsed"]), None

    def start(self) -> None:
        self._begin = clock.monotonic()

    @property
    def elapsed(self) -> float:
        return self._before + (0.0 if self._begin is None else clock.monotonic() - self._begin)
