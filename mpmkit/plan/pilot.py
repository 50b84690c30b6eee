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
        return cls(1.0, 1.0, 1.0, nan, nan, nan, nan, nan, of_the_case=False)


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
    first_step, first = simulation.time_step, counted(simulation)
    begin, before = clock.perf_counter(), simulation.particle_steps
    start_steps, start_time = simulation.steps, simulation.time
    parts = PartClock(simulation)
    wider, walls = coarse.grid.cell_size / case.grid.cell_size, 0.0
    try:
        while simulation.time < coarse.end and clock.perf_counter() - begin < seconds:
            simulation.advance(coarse.end - simulation.time)
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
    mean, passed = (simulation.particle_steps - before) / steps, simulation.time - start_time
    return Growth(
        steps=steps / (passed / first_step),
        particles=mean / first,
        last_particles=len(simulation.particles) / first,
        seconds_per_step=taken / steps,
        mean_particles=mean,
        seconds_of_parts=parts.seconds / steps,
        walls=walls / steps,
        redistributions=parts.redistributions / passed,
        of_the_case=coarse is case,
    )


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
