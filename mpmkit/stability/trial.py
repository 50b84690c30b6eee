"""A run with steps that nobody vouches for, and what is looked at on its way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..case.model import Case
from ..errors import GuardStop
from ..solver.simulation import Simulation

ROWS = 40
"""Times at which a trial is looked at."""


@dataclass(frozen=True)
class Trace:
    """What a trial did, at ``ROWS`` times from the start on; shorter where a guard stopped it."""

    time: np.ndarray
    energy: np.ndarray
    """(rows,) kinetic, potential, elastic and compressive energy together, J"""
    kinetic: np.ndarray
    momentum: np.ndarray
    """(rows, dim) kg m/s"""
    position: np.ndarray
    """(rows, n, dim) by the particles' numbers, m"""
    mass: np.ndarray
    stopped_by: str | None


def trace(case: Case, fraction: float) -> Trace:
    """Run a case with ``fraction`` of the smallest limit that it does not ignore, whatever schemes bear."""
    simulation = Simulation(case, fraction=fraction)
    simulation.guards.watches_energy = False  # the judge looks at it, and more closely
    rows, stopped_by = [], None
    with np.errstate(all="ignore"):
        try:
            for time in np.linspace(0.0, case.until, ROWS):
                while simulation.time < time * (1 - 1e-12):
                    simulation.advance(time - simulation.time)
                rows.append(_row(simulation))
            simulation.check()
        except GuardStop as stop:
            stopped_by = stop.guard
    p = simulation.particles
    time, energy, kinetic, momentum, position = (np.array(column) for column in zip(*rows, strict=True))
    return Trace(time, energy, kinetic, momentum, position, p.mass[np.argsort(p.number)], stopped_by)


def _row(simulation: Simulation) -> tuple:
    p, found = simulation.particles, simulation.measures(simulation.particles)
    energies = ("kinetic_energy", "potential_energy", "strain_energy", "compressive_energy")
    return (
        simulation.time,
        sum(float(found[name]) for name in energies),
        float(found["kinetic_energy"]),
        found["momentum"],
        p.position[np.argsort(p.number)].copy(),
    )
