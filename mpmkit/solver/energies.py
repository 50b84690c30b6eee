"""The energies of the particles, J: of motion, of shape, of volume, and in the field of gravity."""

from __future__ import annotations

import numpy as np

from ..kernels import sums
from ..registry.audit import require_shape
from .particles import Particles


def kinetic_energy(p: Particles) -> float:
    """½ Σ m v², of the particles' own velocities, without what an affine part adds within each."""
    return 0.5 * float(sums.kinetics(p.mass, p.velocity)[1])


def strain_energy(p: Particles) -> float:
    """Elastic energy of shape, of all laws."""
    total = 0.0
    for group in p.groups:
        volume = p.initial_volume[group.part]
        density = group.law.strain_energy(p.kinematics(group), group.state, p.stress[group.part])
        if np.ndim(density):
            require_shape(group.law, "strain_energy", density, volume.shape)
            total += _integral(density, volume)
        elif density:
            total += float(density) * float(np.sum(volume))
    return total


def compressive_energy(p: Particles) -> float:
    """Energy of the equations of state."""
    total = 0.0
    for group in p.groups:
        if group.law.uses_equation_of_state:
            volume = p.initial_volume[group.part]
            density = group.compressive_energy(p.volume_ratio[group.part])
            require_shape(group.equation_of_state, "energy", density, volume.shape)
            total += _integral(density, volume)
    return total


def _integral(density: np.ndarray | float, volume: np.ndarray) -> float:
    return float(sums.product(np.ascontiguousarray(density, dtype=float), volume))


def potential_energy(p: Particles, gravity: np.ndarray) -> float:
    """-Σ m g·x, with x from the grid's lower corner."""
    return -weighted(p, p.position, gravity)


def weighted(p: Particles, vectors: np.ndarray, along: np.ndarray) -> float:
    """Σ m v·a, of vectors ``(n, dim)`` and a direction."""
    return float(sums.moment(p.mass, vectors, along)) if along.any() else 0.0
