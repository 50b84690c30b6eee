"""A state in mid-flow at low cost: a coarse run, whose particles are then divided."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from ..case import parse_case
from ..case.model import Case
from ..solver.particles import Particles
from ..solver.simulation import Simulation
from .scenes import ACCURATE, EXACT, FLOWING, BenchScene


def in_mid_flow(scene: BenchScene) -> Simulation:
    """The scene some tenths of a second after its release, when particles lie irregularly, as in a real run.

    A run on cells ``coarser`` times as large, with the accurate scheme, gives the flow. The boxes of its
    particles are divided into boxes of the size in the scene.
    """
    case = parse_case(scene.case)
    flowing = Simulation(parse_case(_coarse(scene)))
    while flowing.time < FLOWING:
        flowing.advance(FLOWING - flowing.time)
    return Simulation(case, _cut(case, flowing.particles, scene.coarser))


def _coarse(scene: BenchScene) -> dict[str, Any]:
    data = copy.deepcopy(scene.case)
    data["grid"]["cell_size"] *= scene.coarser
    data["bodies"][0]["material"] = EXACT
    data["scheme"] = ACCURATE
    return data


def _cut(case: Case, coarse: Particles, times: int) -> Particles:
    """Every particle divided into ``times`` parts along each axis, with its affine velocity field."""
    fine = Simulation(case).particles
    dim = coarse.dim
    steps = (2 * np.arange(times) + 1) / times - 1
    corners = np.stack(np.meshgrid(*[steps] * dim, indexing="ij"), axis=-1).reshape(-1, dim)
    parent = np.repeat(np.arange(len(coarse)), len(corners))
    offset = np.tile(corners, (len(coarse), 1)) * coarse.box[parent]
    # Group, law and optional arrays of the fine particles, one entry for each part.
    fine.take(np.zeros(len(parent), dtype=np.int64))
    group = fine.groups[0]
    group.part = slice(0, len(parent))
    group.state = {name: np.repeat(array[:1], len(parent), axis=0) for name, array in group.state.items()}
    fine.number = np.arange(len(parent))
    fine.position = np.maximum(coarse.position[parent] + offset, 1e-9)
    fine.velocity = coarse.velocity[parent] + np.einsum("pij,pj->pi", coarse.affine[parent], offset)
    if fine.affine.shape[1]:
        fine.affine = coarse.affine[parent]
    fine.box = coarse.box[parent] / times
    fine.volume_ratio = coarse.volume_ratio[parent]
    fine.initial_volume = coarse.initial_volume[parent] / len(corners)
    if case.space_.radial:  # equal boxes differ in volume as their radii do
        fine.initial_volume *= fine.position[:, 0] / coarse.position[parent, 0]
    fine.volume = fine.initial_volume * fine.volume_ratio
    fine.mass = group.density * fine.initial_volume
    if fine.least_half_size is not None:
        fine.half_size = np.maximum(fine.box, fine.least_half_size)
    fine.stress = coarse.stress[parent]
    fine.pressure = group.pressure(fine.volume_ratio)
    return fine
