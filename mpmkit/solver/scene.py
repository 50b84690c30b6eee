"""From a case to its particles."""

from __future__ import annotations

import numpy as np

from ..case.bodies import Body
from ..case.material import Material
from ..case.model import Case
from ..case.sound_speed import SoundSpeedMach
from ..contracts.law import initial_state
from ..errors import CaseError
from ..geometry import Sample, sample, shared_volume
from ..registry import audit
from .overlaps import refuse_overlaps_with_walls
from .particles import Group, Particles

LEAST_WIDTH = 1 / 8
"""Least width, in cells per dimension, of a domain that follows the strain, unless it was smaller at the
start.

At the surface of the material, a node that a box of width w (in cells) overlaps by a small length e has the
weight e²/2w and the gradient e/w. The stiffness of the node is the squared gradient over the weight, 2/w: it
grows when the box becomes thin, and in a corner along d axes at once. The critical step of USL, which takes
the stress from that node, then falls to √w of dx/c and to w of the viscous limit along one axis; in a corner
in two dimensions, at this width, to 0.42 of dx/c.
"""


def materials_of(case: Case) -> list[Material]:
    """The different materials of a case, in the order of their groups of particles."""
    materials: list[Material] = []
    for material in case.materials.values():
        if material not in materials:
            materials.append(material)
    return materials


def make_particles(case: Case) -> Particles:
    """Fill the bodies with particles; bodies and sources of the same material share a group."""
    materials = materials_of(case)
    bodies = [
        (number, body) for m in materials for number, body in enumerate(case.bodies) if body.material == m
    ]
    _refuse_overlaps(case)
    samples = [_sample_body(case, number) for number, _ in bodies]
    refuse_overlaps_with_walls(case, zip((number for number, _ in bodies), samples, strict=True))
    counts = np.array([len(found.volume) for found in samples], dtype=np.int64)

    lower, _ = case.domain_bounds
    nowhere = np.empty((0, case.space_.dim))
    velocities = [
        _initial_velocity(body, found.position) for (_, body), found in zip(bodies, samples, strict=True)
    ]
    particles = fresh_particles(
        case,
        number=np.arange(counts.sum(), dtype=np.int64),
        body=np.repeat(np.array([number for number, _ in bodies], dtype=np.int32), counts),
        position=np.concatenate([nowhere, *(found.position for found in samples)]) - lower,
        velocity=np.concatenate([nowhere, *velocities]),
        density=np.repeat(np.array([body.material.density for _, body in bodies]), counts),
        volume=np.concatenate([np.empty(0), *(found.volume for found in samples)]),
        half_size=np.concatenate([nowhere, *(found.half_size for found in samples)]),
    )
    start = 0
    for material in materials:
        end = start + sum(c for c, (_, body) in zip(counts, bodies, strict=True) if body.material == material)
        particles.groups.append(material_group(case, material, slice(start, end)))
        start = end
    return particles


def fresh_particles(
    case: Case,
    number: np.ndarray,
    body: np.ndarray,
    position: np.ndarray,
    velocity: np.ndarray,
    density: np.ndarray,
    volume: np.ndarray,
    half_size: np.ndarray,
) -> Particles:
    """Particles in the state in which material begins, without groups.

    Args:
        case: defines which arrays the schemes need.
        number, body: ``(n,)`` integers.
        position, velocity, half_size: ``(n, dim)``, m and m/s, positions from the grid's lower corner.
        density, volume: ``(n,)``, kg/m³ and m³.
    """
    n = len(position)
    rule = audit.particle_domain(case.scheme.shape)
    affine = case.space_.dim if case.scheme.velocity.affine else 0
    return Particles(
        number=number,
        body=body,
        position=position,
        velocity=velocity,
        affine=np.zeros((n, affine, affine)),
        mass=density * volume,
        initial_volume=volume,
        volume=volume.copy(),
        volume_ratio=np.ones(n),
        half_size=half_size,
        initial_half_size=half_size.copy() if rule in ("stretch", "volume") else None,
        least_half_size=np.minimum(half_size, LEAST_WIDTH * case.space_.dim * case.grid.cell_size / 2)
        if rule == "strain"
        else None,
        box=half_size.copy(),
        velocity_gradient=np.zeros((n, 3, 3)),
        stress=np.zeros((n, 6)),
        pressure=np.zeros(n),
        mapped_pressure=np.zeros(n),
        quadrature=np.ones(n),
        expansion=np.zeros(n),
        deformation_gradient=np.tile(np.eye(3), (n, 1, 1)) if tracks_deformation(case) else None,
        portion=np.ones(n),
        age=np.zeros(n),
    )


def tracks_deformation(case: Case) -> bool:
    """Whether the particles of a case carry a deformation gradient."""
    return case.scheme.shape.particle_domain == "stretch" or any(
        material.constitutive_law.needs_deformation_gradient for material in case.materials.values()
    )


def material_group(case: Case, material: Material, part: slice) -> Group:
    """The particles ``part`` of a material, in the state in which a run begins."""
    count, speed = part.stop - part.start, case.sound_speed(material)
    law = material.constitutive_law.in_scene(material.density, speed, case.scale)
    return Group(
        law=law,
        equation_of_state=material.equation_of_state,
        density=material.density,
        sound_speed=speed,
        mach=material.sound_speed.mach if isinstance(material.sound_speed, SoundSpeedMach) else None,
        part=part,
        state=initial_state(law, count),
    )


def _refuse_overlaps(case: Case) -> None:
    """Refuse bodies whose shapes overlap, even by less than a particle: this mass would count twice."""
    space, spacing = case.space_, [_spacing(case, body) for body in case.bodies]
    for number, body in enumerate(case.bodies):
        for other in range(number):
            shared = shared_volume(
                body.shape,
                case.bodies[other].shape,
                space,
                np.minimum(spacing[number], spacing[other]),
                case.domain_bounds,
            )
            if shared > 0:
                raise CaseError(
                    f"bodies.{number}.shape and bodies.{other}.shape overlap: they share {shared:.3g} m³, "
                    f"{shared / body.shape.volume(space):.2g} of bodies.{number}; bodies may touch but not "
                    "overlap"
                )


def _spacing(case: Case, body: Body) -> np.ndarray:
    """Distance of a body's particles, m, (dim,)."""
    return case.grid.cell_size / np.array(body.particles_along_axes(case.space_.dim), dtype=float)


def _initial_velocity(body: Body, position: np.ndarray) -> np.ndarray:
    if body.velocity is None:
        return np.zeros_like(position)
    if isinstance(body.velocity, list):
        return np.tile(np.array(body.velocity), (len(position), 1))
    return body.velocity.at(position)


def _sample_body(case: Case, number: int) -> Sample:
    body, space = case.bodies[number], case.space_
    bounds = case.domain_bounds
    found = sample(
        body.shape,
        space,
        origin=bounds[0],
        cell_size=case.grid.cell_size,
        per_axis=body.particles_along_axes(space.dim),
        keep=bounds,
    )
    if len(found.volume) == 0:
        spacing = " by ".join(f"{s:g}" for s in _spacing(case, body))
        raise CaseError(
            f"bodies.{number}.shape holds no particle at a cell size of {case.grid.cell_size:g} m: particles "
            f"are {spacing} m apart, and along each axis the body must be at least half as thick; "
            "it must be larger, or the cells smaller"
        )
    return found
