"""When a run is unstable: not when it has become no number, but when its physics has become wrong."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..case.model import Case
from .trial import Trace


@dataclass(frozen=True)
class Criteria:
    """What is allowed. Each is a part of what the fine solution has of the same."""

    energy: float = 0.01
    """energy created, over the largest change of kinetic or total energy"""
    momentum: float = 1e-6
    """created momentum, over the largest momentum that any part of the body could have"""
    distance: float = 0.05
    """root mean square distance of the particles, over their displacement"""

    def broken(self, case: Case, found: Trace, fine: Trace) -> str | None:
        """Which criterion a run breaks first of guard, energy, momentum, distance; None if it is stable."""
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
    """Root mean square distance between two runs at its largest, over the largest displacement."""
    weight = fine.mass / fine.mass.sum()
    apart = np.sqrt(((found.position - fine.position) ** 2).sum(axis=2) @ weight)
    moved = np.sqrt(((fine.position - fine.position[0]) ** 2).sum(axis=2) @ weight)
    return float(apart.max() / moved.max()) if moved.max() > 0 else float(apart.max() > 0)


def _created(fine: Trace) -> float:
    """Energy that even the finest steps create, such as USF does on average: not the fault of the step."""
    return max(float(fine.energy.max() - fine.energy[0]), 0.0)


def _isolated(case: Case) -> bool:
    """Whether nothing but gravity acts on the body from outside."""
    return case.space != "axisymmetric" and all(
        case.grid.faces.get(face, "open") in ("open", "periodic") for face in case.space_.faces
    )


def _from_nowhere(case: Case, found: Trace) -> float:
    mass = found.mass.sum()
    expected = found.momentum[0] + mass * np.outer(found.time, case.gravity_vector)
    scale = max(np.sqrt(2 * mass * found.kinetic.max()), np.finfo(float).tiny)
    return float(np.abs(found.momentum - expected).max() / scale)
