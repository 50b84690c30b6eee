"""Criteria for an unstable run: wrong physics, and not only values that are not finite."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..case.model import Case
from .trial import Trace


@dataclass(frozen=True)
class Criteria:
    """Allowed errors, each relative to a quantity of the fine solution."""

    energy: float = 0.01
    """energy created, over the largest change of kinetic or total energy"""
    momentum: float = 1e-6
    """created momentum, over the largest momentum that any part of the body could have"""
    distance: float = 0.05
    """root mean square distance of the particles, over their displacement"""

    def broken(self, case: Case, found: Trace, fine: Trace) -> str | None:
        """The first violated criterion of guard, energy, momentum, distance; None if the run is stable."""
        if found.stopped_by is not None or len(found.time) < len(fine.time):
            return "guard"
        if not np.isfinite(found.energy).all():
            return "guard"
        scale = max(np.ptp(fine.energy), fine.kinetic.max())
        if found.energy.max() - found.energy[0] > self.energy * scale + _created(fine):
            return "energy"
        if _isolated(case) and _from_nowhere(case, found) > self.momentum:
            return "momentum"
        if distance(found, fine) > self.distance:
            return "distance"
        return None


def distance(found: Trace, fine: Trace) -> float:
    """Largest RMS distance between two runs, relative to the largest displacement."""
    apart, weight = distances(found, fine), fine.mass / fine.mass.sum()
    moved = np.sqrt(((fine.position - fine.position[0]) ** 2).sum(axis=2) @ weight)
    return float(apart.max() / moved.max()) if moved.max() > 0 else float(apart.max() > 0)


def distances(found: Trace, fine: Trace) -> np.ndarray:
    """RMS distance, m, between two runs at the rows that both have."""
    rows = min(len(found.position), len(fine.position))
    squared = ((found.position[:rows] - fine.position[:rows]) ** 2).sum(axis=2)
    return np.sqrt(squared @ (fine.mass / fine.mass.sum()))


def _created(fine: Trace) -> float:
    """Energy that even the finest steps create, for example with USF; it does not depend on the step."""
    return max(float(fine.energy.max() - fine.energy[0]), 0.0)


def _isolated(case: Case) -> bool:
    """Whether gravity is the only external force on the body."""
    return (
        case.space != "axisymmetric"
        and not case.varying_forces
        and all(case.grid.faces.get(face, "open") in ("open", "periodic") for face in case.space_.faces)
    )


def _from_nowhere(case: Case, found: Trace) -> float:
    mass = found.mass.sum()
    expected = found.momentum[0] + mass * np.outer(found.time, case.gravity_vector)
    scale = max(np.sqrt(2 * mass * found.kinetic.max()), np.finfo(float).tiny)
    return float(np.abs(found.momentum - expected).max() / scale)
