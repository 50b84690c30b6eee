"""A pilot: the same scene on coarse cells, run to its end to find how its cost grows.

Splitting of particles, changes of the step, and contact with walls during the flow cannot be known from the
initial state. But they are similar, in proportion, on cells four or eight times as wide, at a small part of
the cost.
"""

from __future__ import annotations

import copy
import math
import time as clock
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..case import parse_case
from ..case.model import Case
from ..case.plugins import plugins_of
from ..case.resolved import resolved
from ..errors import MpmkitError, PluginStop
from ..registry import audit
from ..registry.blame import blaming_plugins
from ..solver.memory import expected_particles
from ..solver.simulation import Simulation
from .part_clock import PartClock
from .wall_load import load

FEW = {2: 250, 3: 1500}
"""Approximate largest number of particles of a pilot, by the number of dimensions."""
GROUPS = 10
"""Groups of steps, by their number of particles, through whose medians a line is drawn."""
COARSEST = 3.0
"""Least height of the scene in cells; with fewer cells, the flow is not realistic."""


@dataclass(frozen=True)
class Growth:
    """Results of a pilot, relative to its first step and to the particles that are ``counted``."""

    steps: float
    """steps done over those that the first step's length would need"""
    particles: float
    """particles, the mean over the steps"""
    last_particles: float
    """particles at the end"""
    seconds_per_step: float
    seconds_per_particle: float
    """by how much a step is longer for one more particle, by a line through the steps of the pilot"""
    mean_particles: float
    """number of particles, the mean over the steps"""
    seconds_of_parts: float
    """seconds of walls and redistributions, included above"""
    walls: float
    """mean load of its walls, see ``wall_load``; converted to the cells of the case"""
    redistributions: float
    """redistributions per second of flow, 1/s"""
    of_the_case: bool
    """whether the pilot was the case itself, so that its seconds are those of the run"""

    @classmethod
    def unknown(cls) -> Growth:
        """No growth; used without a pilot."""
        nan = math.nan
        return cls(1.0, 1.0, 1.0, nan, nan, nan, nan, nan, nan, of_the_case=False)


def pilot(case: Case, seconds: float) -> Growth | None:
    """Run a coarse copy of a case for at most ``seconds``; None if it diverges in its first half.

    If the time is too short, or a guard stops it later, the results so far are used for the rest.

    Raises:
        PluginStop: a plug-in is at fault.
    """
    try:
        coarse = coarser(case)
        simulation = Simulation(coarse)
        simulation.advance()  # loads the compiled code
    except PluginStop:  # the run would fail in the same way
        raise
    except MpmkitError:
        return None
    first_step, first = simulation.time_step, float(len(simulation.particles))
    begin, before = clock.perf_counter(), simulation.particle_steps
    start_steps, start_time = simulation.steps, simulation.time
    parts = PartClock(simulation)
    wider, walls = coarse.grid.cell_size / case.grid.cell_size, 0.0
    numbers, taken_by_each = [], []
    try:
        while simulation.time < coarse.end and clock.perf_counter() - begin < seconds:
            start = clock.perf_counter()
            simulation.advance(coarse.end - simulation.time)
            taken_by_each.append(clock.perf_counter() - start)
            numbers.append(len(simulation.particles))
            walls += load(simulation, wider)
    except PluginStop:
        raise
    except MpmkitError:
        if simulation.time < coarse.end / 2:
            return None
    taken = clock.perf_counter() - begin
    steps = simulation.steps - start_steps
    if steps == 0:
        return None
    if case.sources:  # in comparison with all that has come in, also where the time was too short
        first = max(1.0, expected_particles(coarse, simulation.time))
    mean, passed = (simulation.particle_steps - before) / steps, simulation.time - start_time
    return Growth(
        steps=steps / (passed / first_step),
        particles=mean / first,
        last_particles=len(simulation.particles) / first,
        seconds_per_step=taken / steps,
        seconds_per_particle=_slope(np.array(numbers), np.array(taken_by_each)),
        mean_particles=mean,
        seconds_of_parts=parts.seconds / steps,
        walls=walls / steps,
        redistributions=parts.redistributions / passed,
        of_the_case=coarse is case,
    )


def _slope(numbers: np.ndarray, seconds: np.ndarray) -> float:
    """Seconds per particle, at least 0 and at most the mean ratio, by a line through medians of groups."""
    parts = np.array_split(np.argsort(numbers, kind="stable"), min(GROUPS, len(numbers)))
    x = np.array([numbers[part].mean() for part in parts])
    y = np.array([np.median(seconds[part]) for part in parts])
    off = x - x.mean()
    slope = float(off @ y / (off @ off)) if (off != 0).any() else 0.0
    return min(max(slope, 0.0), float(y.mean() / max(x.mean(), 1.0)))


def counted(simulation: Simulation) -> float:
    """Particles at the start; of a scene with sources, those that there will have been at its end."""
    return expected_particles(simulation.case) if simulation.case.sources else len(simulation.particles)


def coarser(case: Case) -> Case:
    """The case on cells so wide that it has few particles; the case itself if it already has few."""
    dim = case.space_.dim
    times = (expected_particles(case) / FEW[dim]) ** (1 / dim)
    times = min(times, case.height / COARSEST / case.grid.cell_size, _thinnest(case) / case.grid.cell_size)
    if times < 1.25:
        return case
    data = resolved(case)
    data["grid"] = copy.deepcopy(data["grid"])
    cell_size = data["grid"]["cell_size"] * times
    data["grid"]["cell_size"] = cell_size
    data["grid"]["domain"] = {axis: _whole(ends, cell_size) for axis, ends in data["grid"]["domain"].items()}
    data["output"] = {"report": False}
    data["until"] = case.end  # an end condition may use measurements of the output
    return parse_case(data, source="its pilot")


def _thinnest(case: Case) -> float:
    """Thickness, m, of the thinnest wall; infinite without walls. No cell may be larger."""
    with blaming_plugins(plugins_of(case)):
        surfaces = [audit.placed(wall.surface, case.space_) for wall in case.walls.values()]
        return min((surface.thickness for surface in surfaces), default=math.inf)


def _whole(ends: list[float], cell_size: float) -> list[Any]:
    """A domain extended to a whole number of cells."""
    return [ends[0], ends[0] + cell_size * math.ceil((ends[1] - ends[0]) / cell_size - 1e-9)]
