"""What frames and histories hold of every particle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..case.state_variables import field_name
from ..kernels.tensors import shear_rate
from ..registry.audit import require_array
from .grid import Grid
from .particles import Particles

ROUNDING = 1e-9
"""Part of the yield stress by which a stress must exceed it to count as yielded."""
VTK_ORDER = [0, 1, 2, 5, 3, 4]
"""Symmetric tensors of VTK are xx, yy, zz, xy, yz, xz."""


def cauchy_stress(p: Particles) -> np.ndarray:
    """Cauchy stress, Pa, ``(n, 6)``, tension positive: the extra stress minus the pressure."""
    stress = p.stress.copy()
    stress[:, :3] -= p.mapped_pressure[:, None]
    return stress


def mean_pressure(p: Particles) -> np.ndarray:
    """Minus the mean normal stress, Pa, ``(n,)``; a solid has it too, though no equation of state."""
    return p.mapped_pressure - p.stress[:, :3].sum(axis=1) / 3


def shear_stress(p: Particles) -> np.ndarray:
    """√(s:s/2) of the deviator s of the stress, Pa, ``(n,)``."""
    s = p.stress.copy()
    s[:, :3] -= s[:, :3].mean(axis=1)[:, None]
    return np.sqrt((s[:, :3] ** 2).sum(axis=1) / 2 + (s[:, 3:] ** 2).sum(axis=1))


def yielded(p: Particles) -> np.ndarray:
    """1 where the shear stress is beyond the yield point of the law, ``(n,)``, else 0.

    For a law that has no yield point, 1 where the material is sheared at all.
    """
    stress, rate = shear_stress(p), shear_rate(p.velocity_gradient)
    found = np.zeros(len(p), dtype=np.int32)
    for group in p.groups:
        part, limit = group.part, group.law.yield_point(group.state)
        if limit is None:
            found[part] = rate[part] > 0
            continue
        if np.ndim(limit):
            require_array(group.law, "yield_point", limit, stress[part].shape)
        found[part] = stress[part] > limit * (1 + ROUNDING)
    return found


def state_fields(p: Particles) -> dict[str, np.ndarray]:
    """State variables of all laws, ``(n,)`` or ``(n, k)``; not a number where the law is another."""
    found: dict[str, np.ndarray] = {}
    for group in p.groups:
        for name, array in group.state.items():
            flat = array.reshape(len(array), -1) if array.ndim > 1 else array
            field = field_name(group.law, name)
            if field not in found:
                found[field] = np.full((len(p), *flat.shape[1:]), np.nan)
            found[field][group.part] = flat
    return found


PARTICLE_FIELDS: dict[str, Callable[[Particles, Grid], np.ndarray]] = {
    "position": lambda p, grid: p.position + grid.lower,
    "velocity": lambda p, grid: p.velocity,
    "stress": lambda p, grid: cauchy_stress(p),
    "pressure": lambda p, grid: mean_pressure(p),
    "volume_ratio": lambda p, grid: p.volume_ratio,
    "shear_rate": lambda p, grid: shear_rate(p.velocity_gradient),
    "shear_stress": lambda p, grid: shear_stress(p),
    "yielded": lambda p, grid: yielded(p),
}
"""Particle fields that a history can keep, beside the state variables."""


def history_fields(p: Particles, grid: Grid, names: list[str]) -> dict[str, np.ndarray]:
    """The fields that a row keeps."""
    states = state_fields(p) if any(name not in PARTICLE_FIELDS for name in names) else {}
    return {n: PARTICLE_FIELDS[n](p, grid) if n in PARTICLE_FIELDS else states[n] for n in names}


def frame_fields(p: Particles) -> dict[str, np.ndarray]:
    """What a frame shows of every particle; docs/cases.md has the units."""
    return {
        "velocity": p.velocity,
        "speed": np.sqrt(np.einsum("pi,pi->p", p.velocity, p.velocity)),
        "pressure": mean_pressure(p),
        "stress": cauchy_stress(p)[:, VTK_ORDER],
        "shear_stress": shear_stress(p),
        "shear_rate": shear_rate(p.velocity_gradient),
        "yielded": yielded(p),
        "volume_ratio": p.volume_ratio,
        "half_size": p.box,
        "body": p.body,
        "particle": p.number,
        **state_fields(p),
    }
