"""A pilot: the same scene on coarse cells, run to its end to see how its cost grows on the way.

Particles that are split, steps that lengthen or shorten as the material flows, and the walls that it touches
on the way cannot be known from the scene at rest; but they are the same, in proportion, on cells four or
eight times as wide, at a small part of the cost.
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
"""Particles of a pilot, by the number of dimensions, at about the most."""
COARSEST = 3.0
"""Cells that the scene is high, at least: with fewer there is no flow to learn from."""


@dataclass(frozen=True)
class Growth:
    """What became of a pilot, over what it was at rest."""

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
    """of them those of walls and redistributions"""
    walls: float
    """what its walls had to do, the mean over the steps, see ``wall_load``; as of the case's own cells"""
    redistributions: float
    """how many there were in a second of the flow, 1/s"""
    of_the_case: bool
    """whether the pilot was the case itself, so that its seconds are those of the run"""

    @classmethod
    def unknown(cls) -> Growth:
        """Nothing grows, as far as is known: without a pilot."""
        nan = math.nan
        return cls(1.0, 1.0, 1.0, nan, nan, nan, nan, nan, of_the_case=False)


def pilot(case: Case, seconds: float) -> Growth | None:
    """Run a coarse copy of a case for at most ``seconds``; None if it diverges in its first half.

    Where the seconds do not suffice, or a guard stops it later, what was seen up to then stands for the rest.

    Raises:
        PluginStop: a plug-in is at fault.
    """
    try:
        coarse = coarser(case)
        simulation = Simulation(coarse)
        simulation.advance()  # loads what must be loaded
    except PluginStop:  # it would fail in the run as well
        raise
    except MpmkitError:
        return None
    first_step, first = simulation.time_step, len(simulation.particles)
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


def coarser(case: Case) -> Case:
    """The case on cells so wide that it has few particles; the case itself if it has few as it is."""
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
    data["until"] = case.end  # a condition may be on what the output has measured
    return parse_case(data, source="its pilot")


def _thinnest(case: Case) -> float:
    """Thickness, m, of the thinnest wall; infinite if there is no wall. No cell may be larger than that."""
    with blaming_plugins(plugins_of(case)):
        surfaces = [audit.placed(wall.surface, case.space_) for wall in case.walls.values()]
        return min((surface.thickness for surface in surfaces), default=math.inf)


def _whole(ends: list[float], cell_size: float) -> list[Any]:
    """A domain that ends a little later, so that it is a whole number of cells wide."""
    return [ends[0], ends[0] + cell_size * math.ceil((ends[1] - ends[0]) / cell_size - 1e-9)]
