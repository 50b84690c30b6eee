"""Times of the parts that differ from step to step: walls and redistributions."""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from typing import Any

from ..solver.simulation import Simulation


class PartClock:
    """Measures the time of walls and redistributions of a simulation, without an effect on its results.

    Work of walls for a redistribution counts to the redistribution.

    Attributes:
        walls: seconds that the walls have taken.
        redistributions: how many there were.
        redistributing: seconds that they have taken.
    """

    def __init__(self, simulation: Simulation) -> None:
        self.walls = self.redistributing = 0.0
        self.redistributions = 0
        self._runs = False
        walls, stage = simulation.operations.walls, simulation.operations.stage
        for name in dir(type(walls)):
            if not name.startswith("_") and callable(getattr(type(walls), name)):
                setattr(walls, name, self._timed(getattr(walls, name), self._add_walls))
        redistribute = self._timed(stage.redistribute_if_due, self._add_redistribution)
        stage.redistribute_if_due = redistribute  # type: ignore[method-assign]

    @property
    def seconds(self) -> float:
        """All together."""
        return self.walls + self.redistributing

    def _add_walls(self, seconds: float, _: Any) -> None:
        self.walls += seconds

    def _add_redistribution(self, seconds: float, done: bool) -> None:
        self.redistributing += seconds
        self.redistributions += done

    def _timed(self, method: Callable[..., Any], add: Callable[[float, Any], None]) -> Callable[..., Any]:
        def timed(*arguments: Any, **named: Any) -> Any:
            if self._runs:  # called by another timed function
                return method(*arguments, **named)
            self._runs, begin = True, clock.perf_counter()
            try:
                found = method(*arguments, **named)
            finally:
                self._runs = False
            add(clock.perf_counter() - begin, found)
            return found

        return timed
