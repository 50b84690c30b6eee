"""The cost of a run before it is run."""

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
from .pilot import Growth, counted, pilot
from .trial import Trial, trial

PILOT_SECONDS = 10.0
"""Longest time of the coarse pilot run, which shows how the cost changes during the run."""
WORTH_ADVICE = 10.0
"""Cheaper models are considered only for runs of at least this many seconds."""
WORTH_A_LINE = 0.8
"""A cheaper model may take at most this part of the run's time."""
WORTH_A_PILOT = 1.0
"""A pilot is run only for runs of at least this many seconds."""


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
    """Cost of every cheaper model that is listed, measured in the same way as for the case."""
    if cost["expected_seconds"] < WORTH_ADVICE:
        return []
    lines = []
    for model in cheaper_models(case):
        try:
            found = _cost(Simulation(model.case), threads)
        except (CaseError, GuardStop):  # it cannot be run, so it is not listed
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
    # These values are for the initial state: the trial below advances the scene.
    limits, step, limited_by = simulation.limits, simulation.time_step, simulation.limited_by
    warnings = [*cautions(case), *forewarnings(case), *simulation.warnings()]
    remarks = simulation.remarks()
    if (end := ending(case.until)) is not None:
        remarks.append(f"{end}: steps, memory and time are those of a run to that time")
    if not math.isfinite(case.end / step):
        raise CaseError(f"until is {case.end:g} s; in steps of {step:.3g} s the number of steps is too large")
    start = trial(simulation)
    growth = _growth(simulation, case.end / step * start.step)
    steps = math.ceil(case.end / step * growth.steps)
    mean = (
        _mean_seconds_of_sources(start, counted(simulation), growth)
        if case.sources
        else _mean_seconds(start, particles, growth, case.end / steps)
    )
    at_end = round(counted(simulation) * growth.last_particles)
    return {
        "particles": particles,
        "particles_at_end": at_end,
        "nodes": list(simulation.grid.nodes),
        "steps": steps,
        "time_step": step,
        "limits": {name: limit if math.isfinite(limit) else None for name, limit in limits.as_dict().items()},
        "limited_by": limited_by,
        "sound_speed": [case.sound_speed(material) for material in case.materials.values()],
        "memory_bytes": expected_bytes(case, at_end),
        "checkpoint_bytes": checkpoint_bytes(case, at_end),
        "expected_seconds": steps * mean,
        "remarks": [*case.grid.extensions, *remarks],
        "warnings": warnings + start.stopped,
    }


def _growth(simulation: Simulation, seconds: float) -> Growth:
    """The growth of particles and steps from a pilot; no growth for a scene in which neither changes."""
    case = simulation.case
    follows = any(group.mach is not None for group in simulation.particles.groups)
    found = None
    if case.sources:  # the first steps, with few particles, say little
        found = pilot(case, PILOT_SECONDS)
    elif (case.scheme.splitting or follows or case.walls) and seconds > WORTH_A_PILOT:
        # Growth makes the run longer than this estimate, and the pilot should reach the end of the flow.
        found = pilot(case, min(PILOT_SECONDS, 2 * seconds))
    return found or Growth.unknown()


def _mean_seconds_of_sources(start: Trial, particles: float, growth: Growth) -> float:
    """Mean seconds per step of a run that begins with few particles: those of the pilot, and of the particles
    that it has more; without a pilot, which cannot be had if it diverges, those of the trial."""
    if growth.of_the_case or not growth.mean_particles > 0:
        return growth.seconds_per_step if growth.of_the_case else start.step
    more = particles * growth.particles - growth.mean_particles
    return growth.seconds_per_step + growth.seconds_per_particle * more


def _mean_seconds(start: Trial, particles: int, growth: Growth, time_step: float) -> float:
    """Mean seconds per step of a run, a + b N + c W + d R, with N particles.

    a, the cost of a step without particles, comes from the pilot, which has few. W is the load of the walls:
    a lifted mould soon leaves the material and then costs nothing. R is the number of redistributions per
    step; the number per second of flow is that of the pilot.
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
