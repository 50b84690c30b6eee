"""From a case to its particles."""

from __future__ import annotations

import numpy as np

from ..case.model import Body, Case
from ..errors import CaseError
from ..geometry import Sample, sample
from .particles import Group, Particles


def particles_along_axes(body: Body, dim: int) -> tuple[int, ...]:
    """Particles along each axis of a cell."""
    given = body.particles_per_cell
    if given is None:
        return (2,) * dim
    if isinstance(given, list):
        return tuple(given)
    return (round(given ** (1 / dim)),) * dim


def kept_box(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """The domain: where a symmetry plane cuts a body, only what lies inside is kept."""
    ends = np.array([case.grid.domain[axis] for axis in case.space_.axes])
    return ends[:, 0], ends[:, 1]


def make_particles(case: Case) -> Particles:
    """Fill the bodies with particles; bodies of the same material share a group."""
    lower, _ = kept_box(case)
    samples = [_sample_body(case, number) for number in range(len(case.bodies))]
    materials: list = []
    for body in case.bodies:
        if body.material not in materials:
            materials.append(body.material)
    order = [i for m in materials for i, body in enumerate(case.bodies) if body.material == m]

    position = np.concatenate([samples[i].position for i in order]) - lower
    volume = np.concatenate([samples[i].volume for i in order])
    half_size = np.concatenate([samples[i].half_size for i in order])
    n, dim = position.shape
    body_of = np.concatenate([np.full(len(samples[i].volume), i, dtype=np.int32) for i in order])
    density = np.array([body.material.density for body in case.bodies])[body_of]
    velocity = np.concatenate([_initial_velocity(case.bodies[i], samples[i].position) for i in order])
    tracks_deformation = case.scheme.shape.particle_domain == "stretch" or any(
        m.constitutive_law.needs_deformation_gradient for m in materials
    )
    particles = Particles(
        number=np.arange(n, dtype=np.int64),
        body=body_of,
        position=position,
        velocity=velocity,
        mass=density * volume,
        initial_volume=volume,
        volume=volume.copy(),
        volume_ratio=np.ones(n),
        initial_half_size=half_size,
        half_size=half_size.copy(),
        velocity_gradient=np.zeros((n, 3, 3)),
        stress=np.zeros((n, 6)),
        pressure=np.zeros(n),
        deformation_gradient=np.tile(np.eye(3), (n, 1, 1)) if tracks_deformation else None,
    )
    start = 0
    for material in materials:
        count = sum(len(samples[i].volume) for i in order if case.bodies[i].material == material)
        law = material.constitutive_law
        state = {
            name: np.full((count, *variable.shape), variable.initial, dtype=float)
            for name, variable in law.state.items()
        }
        particles.groups.append(
            Group(
                law=law,
                equation_of_state=material.equation_of_state,
                density=material.density,
                sound_speed=case.sound_speed(material),
                part=slice(start, start + count),
                state=state,
            )
        )
        start += count
    return particles


def _initial_velocity(body: Body, position: np.ndarray) -> np.ndarray:
    if body.velocity is None:
        return np.zeros_like(position)
    if isinstance(body.velocity, list):
        return np.tile(np.array(body.velocity), (len(position), 1))
    return body.velocity.at(position)


def _sample_body(case: Case, number: int) -> Sample:
    body, space = case.bodies[number], case.space_
    box = kept_box(case)
    found = sample(
        body.shape,
        space,
        origin=box[0],
        cell_size=case.grid.cell_size,
        per_axis=particles_along_axes(body, space.dim),
        keep=box,
    )
    if len(found.volume) == 0:
        raise CaseError(
            f"bodies.{number}.shape holds no particle at a cell size of {case.grid.cell_size:g} m; "
            "it must be larger, or the cells smaller"
        )
    return found
