"""The amplification of one step near rest: the exact matrix by which it multiplies a disturbance."""

from __future__ import annotations

import itertools

import numpy as np

import mpmkit

STRAIN = 1e-6
"""Size of what is tried in an amplification: everything stays linear."""


def amplification(simulation: mpmkit.Simulation, dt: float, axes: int = 1) -> np.ndarray:
    """The matrix by which one step multiplies what moves and strains a body at rest, along the first axes.

    Velocities, affine velocities, and stretches or, of a fluid, volume ratios: every one of them is given a
    little, by itself, and a step is made.
    """
    p, ops, group = simulation.particles, simulation.operations, simulation.particles.groups[0]
    ops.begin()  # the first sorts the particles
    rest = {name: array.copy() for name, array in p.arrays().items()}
    tensor = list(np.ndindex(axes, axes))
    fluid = group.law.uses_equation_of_state
    fields: list[tuple[str, tuple]] = [("velocity", (axis,)) for axis in range(axes)]
    fields += [("volume_ratio", ())] if fluid else [("deformation_gradient", at) for at in tensor]
    fields += [("affine", at) for at in tensor] if simulation.case.scheme.velocity.affine else []
    columns = []
    for (field, at), particle in itertools.product(fields, range(len(p))):
        for name, array in rest.items():
            getattr(p, name)[...] = array
        getattr(p, field)[(particle, *at)] += STRAIN
        if fluid:
            p.volume[:] = p.volume_ratio * p.initial_volume
            p.pressure[:] = group.pressure(p.volume_ratio)
        else:
            p.volume_ratio[:] = np.linalg.det(p.deformation_gradient)
            group.law.update_stress(p.kinematics(group), group.state, dt, p.stress)
        ops.begin()
        ops.step(dt)
        found = [(getattr(p, name) - rest[name])[(slice(None), *index)] for name, index in fields]
        columns.append(np.concatenate(found) / STRAIN)
    for name, array in rest.items():
        getattr(p, name)[...] = array
    return np.array(columns).T


def growth(simulation: mpmkit.Simulation, dt: float, axes: int = 1) -> float:
    """By how much one step can multiply a disturbance: the largest eigenvalue."""
    return float(np.abs(np.linalg.eigvals(amplification(simulation, dt, axes))).max())


def largest_step(
    simulation: mpmkit.Simulation, low: float, high: float, tried: int = 120, axes: int = 1
) -> float:
    """The first step, going up, that lets something grow; by bisection between those tried."""

    def grows(dt: float) -> bool:
        return growth(simulation, dt, axes) > 1 + 1e-3

    steps = np.geomspace(low, high, tried)
    first = next((i for i, dt in enumerate(steps) if grows(dt)), None)
    if not first:
        return low if first == 0 else high
    below, above = steps[first - 1 : first + 1]
    for _ in range(6):
        middle = np.sqrt(below * above)
        below, above = (below, middle) if grows(middle) else (middle, above)
    return float(below)
