"""Fields of the particles in frames and histories."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from ..case.state_variables import former_names
from ..kernels.tensors import shear_rate
from ..registry.audit import require_array
from .grid import Grid
from .observation import Observation
from .particles import Particles
from .state_fields import state_fields
from .stresses import cauchy_stress, mean_pressure, shear_stress
from .view import SceneView

ROUNDING = 1e-9
"""A stress counts as yielded if it exceeds the yield stress by this part of it."""
VTK_ORDER = [0, 1, 2, 5, 3, 4]
"""Symmetric tensors of VTK are xx, yy, zz, xy, yz, xz."""


def yielded(p: Particles) -> np.ndarray:
    """1 where the shear stress exceeds the yield stress of the law, ``(n,)``, else 0.

    For a law without yield stress: 1 where the shear rate is not zero.
    """
    stress, rate = shear_stress(p), shear_rate(p.velocity_gradient)
    found = np.zeros(len(p), dtype=np.int32)
    for group in p.present_groups:
        part, limit = group.part, group.law.yield_point(group.state)
        if limit is None:
            found[part] = rate[part] > 0
            continue
        if np.ndim(limit):
            require_array(group.law, "yield_point", limit, stress[part].shape)
        found[part] = stress[part] > limit * (1 + ROUNDING)
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
    "age": lambda p, grid: p.age,
}
"""Particle fields that a history can keep, besides the state variables."""


def history_fields(scene: SceneView) -> dict[str, np.ndarray]:
    """The particle fields of a row.

    Raises:
        PluginFault: a particle field is not valid.
    """
    case, p = scene.case, scene.particles
    names = case.output.particle_history
    former = former_names(case)
    own = [name for name in names if name in PARTICLE_FIELDS and name not in former | case.output.fields]
    others = [name for name in names if name not in own]
    known = state_fields(p) | added_fields(scene, others) if others else {}
    return {
        name: PARTICLE_FIELDS[name](p, scene.grid) if name in own else known[former.get(name, name)]
        for name in names
    }


def added_fields(scene: SceneView, names: Iterable[str] | None = None) -> dict[str, np.ndarray]:
    """The particle fields of the case, or those of some names, ``(n,)`` or ``(n, k)``."""
    fields, observed = scene.case.output.fields, Observation(scene)
    found = {}
    for name in fields if names is None else [name for name in names if name in fields]:
        values = fields[name].values(observed)
        require_array(fields[name], "values", values, (len(observed.number), *fields[name].shape))
        found[name] = values.reshape(len(values), -1) if values.ndim > 1 else values
    return found


def frame_fields(scene: SceneView) -> dict[str, np.ndarray]:
    """What a frame shows of every particle; docs/cases.md has the units.

    Raises:
        PluginFault: a particle field is not valid.
    """
    p = scene.particles
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
        "age": p.age,
        "body": p.body,
        "particle": p.number,
        **state_fields(p),
        **added_fields(scene),
    }
