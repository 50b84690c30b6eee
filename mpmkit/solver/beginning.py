"""Particles in the initial state that the case gives: velocity, stress and state variables of its bodies.

A stress is given to a fluid by its volume ratio and, if its law remembers one, its extra stress; to a solid
by its deformation gradient. Positions are not changed. Forces are mapped with the volumes J V0: it is J σ
that is the given stress, so that a weight is balanced at the nodes.
"""

from __future__ import annotations

import numpy as np

from ..case.bodies import Body
from ..case.model import Case
from ..contracts import ElastoviscoplasticLaw, ElastoviscoplasticLawWithState, Kinematics
from ..errors import CaseError
from ..registry.audit.initial_fields import LAW
from .particles import Group, Particles
from .rest import ratio_under

REMEMBERS = ElastoviscoplasticLaw, ElastoviscoplasticLawWithState
"""Laws whose stress of the last step is a part of their state."""
ROUNDING = 1e-9
ITERATIONS, STEP, CLOSE = 30, 1e-6, 1e-10
"""Of Newton's method: most iterations, difference in ln λ, and error over the modulus."""


def begin_with_fields(case: Case, particles: Particles, lower: np.ndarray) -> bool:
    """Give the particles the initial fields of their bodies; ``lower`` is the corner of the grid, m.

    Returns:
        Whether any of them is a stress.
    """
    p, stressed = particles, False
    for group in p.groups:
        of_group = p.body[group.part]
        for number in np.unique(of_group):
            body = case.bodies[int(number)]
            index = np.flatnonzero(of_group == number) + group.part.start
            for name in body.initial:
                values = case.at_start(body, name, p.position[index] + lower)
                if name == "velocity":
                    p.velocity[index] = values
                elif name == "stress":
                    stressed = True
                    _press(f"bodies.{number}.initial.stress", body, p, group, index, values)
                else:
                    group.state[name.removeprefix(LAW)][index - group.part.start] = values
    return stressed


def _press(where: str, body: Body, p: Particles, group: Group, index: np.ndarray, stress: np.ndarray) -> None:
    if group.law.uses_equation_of_state:
        _press_fluid(where, p, group, index, stress)
    else:
        _press_solid(where, p, group, index, stress)


def _press_fluid(where: str, p: Particles, group: Group, index: np.ndarray, stress: np.ndarray) -> None:
    pressure = -stress[:, :3].mean(axis=1)
    extra = stress.copy()
    extra[:, :3] += pressure[:, None]
    if pressure.min() < 0:
        raise CaseError(f"{where} has a pressure of {pressure.min():.4g} Pa; a fluid needs 0 or more")
    if np.abs(extra).max() > ROUNDING * np.abs(stress).max() and not isinstance(group.law, REMEMBERS):
        raise CaseError(
            f"{where} has a shear stress, but the law '{group.law.name}' has one only where it flows; give "
            "a pressure, such as the kind 'hydrostatic'"
        )
    ratio = ratio_under(group, pressure)
    if ratio is None:
        raise CaseError(
            f"{where} has a pressure of {pressure.max():.4g} Pa, which would press the fluid to less than "
            "half of its volume; raise sound_speed"
        )
    p.volume_ratio[index] = ratio
    p.volume[index] = ratio * p.initial_volume[index]
    p.pressure[index] = group.pressure(ratio)
    p.stress[index] = extra / ratio[:, None]


def _press_solid(where: str, p: Particles, group: Group, index: np.ndarray, stress: np.ndarray) -> None:
    """Solve J σ(F) = stress for F = diag(λ) by Newton's method in ln λ."""
    if np.abs(stress[:, 3:]).max() > ROUNDING * np.abs(stress).max():
        raise CaseError(f"{where} has a shear stress between the axes, which a solid cannot start with")
    state = {name: array[index - group.part.start] for name, array in group.state.items()}

    def found(stretch: np.ndarray) -> np.ndarray:
        F = np.zeros((len(stretch), 3, 3))
        F[:, range(3), range(3)] = np.exp(stretch)
        J, written = np.exp(stretch.sum(axis=1)), np.zeros((len(stretch), 6))
        kinematics = Kinematics(np.zeros_like(F), J, np.zeros_like(J), group.density, F)
        kept = {name: array.copy() for name, array in state.items()}
        group.law.update_stress(kinematics, kept, 1.0, written)
        return J[:, None] * written[:, :3]

    modulus = group.density * group.wave_speed**2
    stretch = np.zeros((len(index), 3))
    for _ in range(ITERATIONS):
        off = stress[:, :3] - found(stretch)
        if not np.abs(off).max() > CLOSE * modulus:
            break
        slope = np.stack(
            [(found(stretch + STEP * e) - found(stretch - STEP * e)) / (2 * STEP) for e in np.eye(3)], axis=2
        )
        stretch = stretch + np.clip(np.linalg.solve(slope, off[:, :, None])[:, :, 0], -0.2, 0.2)
    else:
        raise CaseError(f"{where} is beyond what the law '{group.law.name}' can bear")
    assert p.deformation_gradient is not None
    p.deformation_gradient[index] = np.exp(stretch)[:, None, :] * np.eye(3)
    ratio = np.exp(stretch.sum(axis=1))
    p.volume_ratio[index] = ratio
    p.volume[index] = ratio * p.initial_volume[index]
    p.stress[index, :3] = found(stretch) / ratio[:, None]
    if p.initial_half_size is not None:  # so that the domains have their sampled size at the start
        p.initial_half_size[index] /= np.exp(stretch)[:, : p.dim]
