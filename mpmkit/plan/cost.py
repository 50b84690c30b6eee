"""What a run will cost, before it is run."""

from __future__ import annotations

import math
from typing import Any

from ..case.ending import ending
from ..case.forewarnings import forewarnings
from ..case.model import Case
from ..case.plugins import cautions
from ..errors import CaseError, GuardStop
from ..running.threads import possible_threads, using_threads
from ..solver.memory import checkpoint_bytes, expected_bytes, require_memory
from ..solver.simulation import Simulation
from .cheaper import cheaper_models
from .expectation import expected_error
from .pilot import Growth, pilot
from .trial import Trial, trial

PILOT_SECONDS = 10.0
"""How long its coarse copy is run at the most, to see how the cost grows on the way."""
WORTH_ADVICE = 10.0
"""Seconds that a run takes at the least, for cheaper models to be looked at."""
WORTH_A_LINE = 0.8
"""Part of the run's time that a cheaper model takes at the most."""
WORTH_A_PILOT = 1.0
"""Seconds that a run takes at the least, for a pilot to be worth its own."""


def plan(case: Case, threads: int | None = None) -> dict[str, Any]:
    """Particles, nodes, steps, memory and expected time of a run.

    The time is measured, not guessed: the scene itself is set up and run for about a second. Where particles
    may be split, the sound speed follows the flow, or there are walls, a coarse copy is run to its end
    (``pilot``).

    Returns:
        ``particles``, ``particles_at_end``, ``nodes`` (along each axis, ghosts included), ``steps``,
        ``time_step`` (s, the first), ``limits`` (s, by name), ``limited_by``, ``sound_speed`` (m/s, a body
        each, at the start), ``memory_bytes`` (at the end), ``checkpoint_bytes`` (more, while a
        checkpoint is written), ``expected_seconds``, ``remarks`` (of the domain and
        the laws),
        ``warnings``, ``expected_error`` (of the spread, see ``advice``; None if not known), ``cheaper``
        (models, each with ``name``, ``why``, ``changes`` by path, ``options`` for the command line,
        ``particles``, ``steps``, ``expected_seconds`` and ``expected_error``).

    Raises:
        CaseError: the case cannot be run.
        GuardStop: it diverges at once, or a plug-in raised an exception.
    """
    require_memory(case)
    threads = possible_threads(threads)
    cost = _cost(Simulation(case), threads)
    return cost | {"expected_error": expected_error(case), "cheaper": _cheaper(case, cost, threads)}


def _cheaper(case: Case, cost: dict[str, Any], threads: int | None) -> list[dict[str, Any]]:
    """Cost of every cheaper model that is worth a line, measured as that of the case is."""
    if cost["expected_seconds"] < WORTH_ADVICE:
        return []
    lines = []
    for model in cheaper_models(case):
        try:
            found = _cost(Simulation(model.case), threads)
        except (CaseError, GuardStop):  # it cannot be run after all, and is no advice
            continue
        if found["expected_seconds"] < WORTH_A_LINE * cost["expected_seconds"]:
            lines.append(
                {"name": model.name, "why": model.why, "changes": model.changes, "options": model.options}
                | {key: found[key] for key in ("particles", "steps", "expected_seconds")}
                | {"expected_error": expected_error(model.case)}
            )
    return lines


def _cost(simulation: Simulation, threads: int | None) -> dict[str, Any]:
    with using_threads(threads, len(simulation.particles)):
        return _cost_of(simulation)


def _cost_of(simulation: Simulation) -> dict[str, Any]:
    case, particles = simulation.case, len(simulation.particles)
    # What follows is of the scene at rest: the trial below moves it on.
    limits, step, limited_by = simulation.limits, simulation.time_step, simulation.limited_by
    warnings = [*cautions(case), *forewarnings(case), *simulation.warnings()]
    remarks = simulation.remarks()
    if (end := ending(case.until)) is not None:
        remarks.append(f"{end}: steps, memory and time are those of a run to that time")
    if not math.isfinite(case.end / step):
        raise CaseError(f"until is {case.end:g} s; in steps of {step:.3g} s that is more than can be counted")
    start = trial(simulation)
    growth = _growth(simulation, case.end / step * start.step)
    steps = math.ceil(case.end / step * growth.steps)
    at_end = round(particles * growth.last_particles)
    return {
        "particles": particles,
        "particles_at_end": at_end,
        "nodes": list(simulation.grid.nodes),
        "steps": steps,
        "time_step": step,
        "limits": {name: limit if math.isfinite(limit) else None for name, limit in limits.as_dict().items()},
        "limited_by": limited_by,
        "sound_speed": [case.sound_speed(body.material) for body in case.bodies],
        "memory_bytes": expected_bytes(case, at_end),
        "checkpoint_bytes": checkpoint_bytes(case, at_end),
        "expected_seconds": steps * _mean_seconds(start, particles, growth, case.end / steps),
        "remarks": [*case.grid.extensions, *remarks],
        "warnings": warnings + start.stopped,
    }


def _growth(simulation: Simulation, seconds: float) -> Growth:
    """What a pilot says of particles and steps to come; nothing of a scene in which neither changes."""
    case = simulation.case
    follows = any(group.mach is not None for group in simulation.particles.groups)
    found = None
    if (case.scheme.splitting or follows or case.walls) and seconds > WORTH_A_PILOT:
        # What grows on the way makes the run longer than this, and the end of the flow should be seen.
        found = pilot(case, min(PILOT_SECONDS, 2 * seconds))
    return found or Growth.unknown()


def _mean_seconds(start: Trial, particles: int, growth: Growth, time_step: float) -> float:
    """Seconds a step takes in the mean over a run, a + b N + c W + d R, with N particles: b N is what grows.

    a, what a step costs whatever the number of particles, is told by the pilot, which has few. W is what the
    walls have to do: a mould that is lifted is soon away from the material, and costs nothing from then on.
    R redistributions are done in a step, as many in a second of the flow as in the pilot.
    """
    if growth.of_the_case:
        return growth.seconds_per_step
    of_walls, redistributions = start.of_walls, start.redistributions
    if start.load > 0 and math.isfinite(growth.walls):
        of_walls *= growth.walls / start.load
    if math.isfinite(growth.redistributions):
        redistributions = min(growth.redistributions * time_step, 1.0)
    per_particle = start.seconds / particles
    if growth.mean_particles < particles / 2:
        of_pilot = growth.seconds_per_step - growth.seconds_of_parts
        per_particle = (start.seconds - of_pilot) / (particles - growth.mean_particles)
        per_particle = min(max(per_particle, 0.0), start.seconds / particles)
    grown = start.seconds + per_particle * particles * (growth.particles - 1.0)
    return grown + of_walls + redistributions * start.redistributing
