"""Time of a step at the start of a run, measured by running the scene for about a second."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass
from statistics import median

from ..errors import GuardStop, PluginStop
from ..solver.simulation import Simulation
from .part_clock import PartClock
from .wall_load import load

TRIAL_SECONDS = 1.0
"""Seconds for which the scene is run, after one step for compilation."""
FORCED = 2
"""Redistributions that are timed; the first one also allocates memory."""


@dataclass(frozen=True)
class Trial:
    """Seconds of the parts of a step."""

    seconds: float
    """without walls and redistributions"""
    of_walls: float
    """of the walls"""
    load: float
    """load of the walls, see ``wall_load``"""
    redistributing: float
    """of one redistribution"""
    redistributions: float
    """mean number of redistributions per step"""
    stopped: list[str]
    """a warning, if a guard stopped the trial"""

    @property
    def step(self) -> float:
        """Mean seconds of a whole step."""
        return self.seconds + self.of_walls + self.redistributions * self.redistributing


def trial(simulation: Simulation) -> Trial:
    """Run a scene for a short time; return a warning if a guard stopped it.

    The median excludes steps that were delayed by other processes. Work of walls that is done only every few
    steps, such as sorting their nodes, is averaged by the mean.
    """
    simulation.advance()  # compiles, or loads compiled code
    taken: list[float] = []
    parts, loads, stopped = PartClock(simulation), 0.0, []
    begin = clock.perf_counter()
    try:
        while not taken or (
            clock.perf_counter() - begin < TRIAL_SECONDS and simulation.time < simulation.case.end
        ):
            start, before = clock.perf_counter(), parts.seconds
            simulation.advance()
            taken.append(clock.perf_counter() - start - (parts.seconds - before))
            loads += load(simulation)
    except GuardStop as stop:
        if not taken or isinstance(stop, PluginStop):
            raise
        stopped = [f"this run will be {stop}"]
    steps, done, of_walls = len(taken), parts.redistributions, parts.walls
    return Trial(
        seconds=median(taken),
        of_walls=of_walls / steps,
        load=loads / steps,
        redistributing=0.0 if stopped else _redistributing(simulation, parts),
        redistributions=done / steps,
        stopped=stopped,
    )


def _redistributing(simulation: Simulation, parts: PartClock) -> float:
    """Seconds of a redistribution, made only to measure it: in the trial it may not have been due."""
    operations, before = simulation.operations, 0.0
    if not operations.stage.acts or not len(simulation.particles):
        return 0.0
    with simulation.blaming:
        for _ in range(FORCED):
            operations.begin()
            operations.stage.shear = operations.stage.elapsed = 1.0
            before = parts.redistributing
            operations.stage.redistribute_if_due(operations.window, operations.sorting)
    return parts.redistributing - before
