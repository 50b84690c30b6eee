"""The energies of the particles, J: kinetic, elastic (shape), of volume change, and potential."""

from __future__ import annotations

import numpy as np

from ..contracts import Plugin
from ..kernels import sums
from ..registry.audit import require_array, require_energy, require_number
from .particles import Group, Particles


def kinetic_energy(p: Particles) -> float:
    """½ Σ m v², without the contribution of the affine velocity inside each particle."""
    return 0.5 * float(sums.kinetics(p.mass, p.velocity)[1])


def strain_energy(p: Particles) -> float:
    """Elastic energy of shape, of all laws."""
    total = 0.0
    for group in p.present_groups:
        volume = p.initial_volume[group.part]
        law = group.law
        density = law.strain_energy(p.kinematics(group), group.state, p.stress[group.part])
        if isinstance(density, np.ndarray) and density.ndim:
            require_array(law, "strain_energy", density, volume.shape)
            _require_stored(p, group, law, density)
            total += _integral(density, volume)
        elif density := require_number(law, "strain_energy", density):
            _require_stored(p, group, law, np.full(1, density))
            total += density * float(np.sum(volume))
    return total


def compressive_energy(p: Particles) -> float:
    """Energy stored by the equations of state."""
    total = 0.0
    for group in p.present_groups:
        if group.law.uses_equation_of_state:
            volume = p.initial_volume[group.part]
            author = group.equation_of_state
            density = group.compressive_energy(p.volume_ratio[group.part])
            require_array(author, "energy", density, volume.shape)
            _require_stored(p, group, author, density)
            total += _integral(density, volume)
    return total


def _require_stored(p: Particles, group: Group, author: Plugin, density: np.ndarray) -> None:
    """Raise PluginFault if a passive law, or its equation of state, stores a negative or infinite energy."""
    if group.law.passive and not 0 <= density.min() <= density.max() < np.inf:
        part, modulus = group.part, group.density * group.wave_speed**2
        require_energy(author, density, p.number[part], p.volume_ratio[part], p.stress[part], modulus)


def _integral(density: np.ndarray | float, volume: np.ndarray) -> float:
    return float(sums.product(np.ascontiguousarray(density, dtype=float), volume))


def potential_energy(p: Particles, gravity: np.ndarray) -> float:
    """-Σ m g·x, with x from the grid's lower corner."""
    return -weighted(p, p.position, gravity)


def weighted(p: Particles, vectors: np.ndarray, along: np.ndarray) -> float:
    """Σ m v·a, of vectors ``(n, dim)`` and a direction."""
    return float(sums.moment(p.mass, vectors, along)) if along.any() else 0.0
