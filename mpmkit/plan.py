"""What a run will cost, before it is run."""

from __future__ import annotations

import math
import time as clock
from statistics import median
from typing import Any

from .case.model import Case
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
        ``expected_seconds``, ``warnings``.

    Raises:
        CaseError: the case cannot be run.
    """
    require_memory(case)
    simulation = Simulation(case)
    particles = len(simulation.particles)
    use_threads(threads, particles)
    limits, step = simulation.limits, simulation.time_step
    steps = math.ceil(case.until / step)
    result = {
        "particles": particles,
        "nodes": list(simulation.grid.nodes),
        "steps": steps,
        "time_step": step,
        "limits": {name: limit if math.isfinite(limit) else None for name, limit in limits.as_dict().items()},
        "limited_by": simulation.limited_by,
        "sound_speed": [case.sound_speed(body.material) for body in case.bodies],
        "memory_bytes": expected_bytes(case, particles),
        "warnings": simulation.warnings(),
    }
    result["expected_seconds"] = steps * _seconds_per_step(simulation)
    return result


def _seconds_per_step(simulation: Simulation) -> float:
    simulation.advance()  # compiles, or loads what was compiled
    taken, begin = [], clock.perf_counter()
    while clock.perf_counter() - begin < TRIAL_SECONDS:
        start = clock.perf_counter()
        simulation.advance()
        taken.append(clock.perf_counter() - start)
    return median(taken)
