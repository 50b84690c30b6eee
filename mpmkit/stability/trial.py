"""A run with steps that may be unstable, and its records."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..case.model import Case
from ..errors import CaseError, GuardStop, PluginStop
from ..solver.grid import Grid
from ..solver.simulation import Simulation

ROWS = 40
"""Number of times at which a trial is recorded."""


@dataclass(frozen=True)
class Trace:
    """Records of a trial at ``ROWS`` times from the start; fewer if a guard stopped it."""

    time: np.ndarray
    """s, of the steps nearest to equal parts of the run; steps are not shortened: that may stabilise them"""
    energy: np.ndarray
    """(rows,) kinetic, potential, elastic and compressive energy together, J"""
    kinetic: np.ndarray
    momentum: np.ndarray
    """(rows, dim) kg m/s"""
    position: np.ndarray
    """(rows, n, dim) positions by particle number, m, at equal parts of the run, extrapolated by the velocity
    of the nearest step; along a periodic axis they continue beyond the faces"""
    mass: np.ndarray
    stopped_by: str | None


def trace(case: Case, fraction: float) -> Trace:
    """Run a case with ``fraction`` of the smallest limit that it does not ignore, even if it is unstable."""
    for key in ("sinks", "sources"):
        if getattr(case, key):
            raise CaseError(f"stability follows every particle to the end: leave out {key}")
    simulation = Simulation(case, fraction=fraction)
    simulation.guards.watches_energy = False  # the judge checks it more strictly
    simulation.guards.watches_density = False  # its errors do not depend on the step
    rows, stopped_by = [], None
    with np.errstate(all="ignore"):
        try:
            with simulation.blaming:
                for time in np.linspace(0.0, case.end, ROWS):
                    while simulation.time + simulation.time_step / 2 <= time:
                        simulation.advance()
                    rows.append(_row(simulation, time - simulation.time))
                simulation.check()
        except PluginStop:
            stopped_by = _diverged(simulation)
            if stopped_by is None:
                raise
        except GuardStop as stop:
            stopped_by = stop.guard
    p = simulation.particles
    time, energy, kinetic, momentum, position = (np.array(column) for column in zip(*rows, strict=True))
    position = _unwrapped(position, simulation.grid)
    return Trace(time, energy, kinetic, momentum, position, p.mass[np.argsort(p.number)], stopped_by)


def _diverged(simulation: Simulation) -> str | None:
    """The guard that stops a run after a fault of a plug-in; None if only the plug-in is wrong.

    A law may fail because the unstable steps have produced invalid particles.
    """
    try:
        simulation.check()
    except PluginStop:
        return None
    except GuardStop as stop:
        return stop.guard
    return None


def _unwrapped(position: np.ndarray, grid: Grid) -> np.ndarray:
    """Positions of particles without wrapping at periodic faces.

    From row to row, no particle may move by more than half the period.
    """
    with np.errstate(all="ignore"):
        steps = np.diff(position, axis=0)
        for axis in np.flatnonzero(grid.periodic):
            period = grid.extent[axis]
            steps[..., axis] -= period * np.rint(steps[..., axis] / period)
        return np.concatenate([position[:1], position[:1] + np.cumsum(steps, axis=0)])


def _row(simulation: Simulation, later: float) -> tuple:
    p, found = simulation.particles, simulation.measures(simulation.particles)
    energies = ("kinetic_energy", "potential_energy", "strain_energy", "compressive_energy")
    return (
        simulation.time,
        sum(float(found[name]) for name in energies),
        float(found["kinetic_energy"]),
        found["momentum"],
        (p.position + later * p.velocity)[np.argsort(p.number)],
    )
