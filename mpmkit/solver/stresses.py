"""Stresses of the particles; the extra stress and the pressure are stored separately."""

from __future__ import annotations

import numpy as np

from .particles import Particles


def cauchy_stress(p: Particles) -> np.ndarray:
    """Cauchy stress, Pa, ``(n, 6)``, tension positive: the extra stress minus the pressure."""
    stress = p.stress.copy()
    stress[:, :3] -= p.mapped_pressure[:, None]
    return stress


def mean_pressure(p: Particles) -> np.ndarray:
    """Minus the mean normal stress, Pa, ``(n,)``; also for solids, which have no equation of state."""
    return p.mapped_pressure - p.stress[:, :3].sum(axis=1) / 3


def shear_stress(p: Particles) -> np.ndarray:
    """√(s:s/2) of the deviator s of the stress, Pa, ``(n,)``."""
    s = p.stress.copy()
    s[:, :3] -= s[:, :3].mean(axis=1)[:, None]
    return np.sqrt((s[:, :3] ** 2).sum(axis=1) / 2 + (s[:, 3:] ** 2).sum(axis=1))
