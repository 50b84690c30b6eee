"""What a step takes where a run begins: the scene itself, run for about a second."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass
from statistics import median

from ..errors import GuardStop, PluginStop
from ..solver.simulation import Simulation
from .part_clock import PartClock
from .wall_load import load

TRIAL_SECONDS = 1.0
"""How long the scene is run, after one step to compile."""
FORCED = 2
"""Redistributions that are done to see what they take; the first also makes room for itself."""


@dataclass(frozen=True)
class Trial:
    """Seconds that a step takes, by what takes them."""

    seconds: float
    """beside walls and redistributions"""
    of_walls: float
    """of the walls"""
    load: float
    """what the walls had to do, see ``wall_load``"""
    redistributing: float
    """of one redistribution"""
    redistributions: float
    """how many there were in a step, in the mean"""
    stopped: list[str]
    """a warning, if a guard stopped the trial"""

    @property
    def step(self) -> float:
        """Seconds of a whole step, in the mean."""
        return self.seconds + self.of_walls + self.redistributions * self.redistributing


def trial(simulation: Simulation) -> Trial:
    """Run a scene for a while, and a warning if a guard stopped it as early as that.

    A step that is held up by something else on the machine is left out by the median. What walls do only in
    every so many steps, such as to sort their nodes, counts in the mean.
    """
    simulation.advance()  # compiles, or loads what was compiled
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
    """Seconds of a redistribution, done for its time alone: in the trial it may not have been due."""
    operations, before = simulation.operations, 0.0
    if not operations.stage.acts:
        return 0.0
    with simulation.blaming:
        for _ in range(FORCED):
            operations.begin()
            operations.stage.shear = operations.stage.time = 1.0
            before = parts.redistributing
            operations.stage.redistribute_if_due(operations.window, operations.sorting)
    return parts.redistributing - before
