"""What a run will cost, before it is run."""

from __future__ import annotations

import math
import time as clock
from statistics import median
from typing import Any

from .blame import blaming_plugins
from .case.model import Case
from .errors import CaseError, GuardStop
from .memory import expected_bytes, require_memory
from .solver.simulation import Simulation
from .threads import use_threads

TRIAL_SECONDS = 1.0
"""How long the scene is run to measure its speed on this machine, after one step to compile."""


def plan(case: Case, threads: int | None = None) -> dict[str, Any]:
    """Particles, nodes, steps, memory and expected time of a run.

    The time is measured, not guessed: the scene itself is set up and run for about a second.

    Returns:
        ``particles``, ``nodes`` (along each axis, ghosts included), ``steps``, ``time_step`` (s), ``limits``
        (s, by name), ``limited_by``, ``sound_speed`` (m/s, a body each), ``memory_bytes``,
        ``expected_seconds``, ``remarks`` (of the laws), ``warnings``.

    Raises:
        CaseError: the case cannot be run.
        GuardStop: it diverges at once, or a plug-in raised an exception.
    """
    require_memory(case)
    with blaming_plugins(case):
        return _plan(Simulation(case), threads)


def _plan(simulation: Simulation, threads: int | None) -> dict[str, Any]:
    case, particles = simulation.case, len(simulation.particles)
    use_threads(threads, particles)
    # What follows is of the scene at rest: the trial below moves it on.
    limits, step, limited_by = simulation.limits, simulation.time_step, simulation.limited_by
    warnings = simulation.warnings()
    if case.scheme.splitting:
        warnings.append("particles that scheme.splitting adds later are not counted in memory and time")
    if not math.isfinite(case.until / step):
        raise CaseError(
            f"until is {case.until:g} s; in steps of {step:.3g} s that is more than can be counted"
        )
    steps = math.ceil(case.until / step)
    seconds_per_step, stopped = _trial(simulation)
    return {
        "particles": particles,
        "nodes": list(simulation.grid.nodes),
        "steps": steps,
        "time_step": step,
        "limits": {name: limit if math.isfinite(limit) else None for name, limit in limits.as_dict().items()},
        "limited_by": limited_by,
        "sound_speed": [case.sound_speed(body.material) for body in case.bodies],
        "memory_bytes": expected_bytes(case, particles),
        "expected_seconds": steps * seconds_per_step,
        "remarks": simulation.remarks(),
        "warnings": warnings + stopped,
    }


def _trial(simulation: Simulation) -> tuple[float, list[str]]:
    """Seconds a step takes, and a warning if the run was stopped by a guard as early as in the trial."""
    simulation.advance()  # compiles, or loads what was compiled
    taken: list[float] = []
    begin = clock.perf_counter()
    try:
        while not taken or (
            clock.perf_counter() - begin < TRIAL_SECONDS and simulation.time < simulation.case.until
        ):
            start = clock.perf_counter()
            simulation.advance()
            taken.append(clock.perf_counter() - start)
    except GuardStop as stop:
        if not taken:
            raise
        return median(taken), [f"this run will be {stop}"]
    return median(taken), []
