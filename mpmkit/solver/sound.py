"""The sound speed against the flow: how fast it flows, and how fast it could come to flow."""

from __future__ import annotations

import math

import numpy as np

from .grid import Grid
from .particles import Particles

SLOWEST = 0.1
"""Part of its first value below which a sound speed that follows the flow does not get, as in a scene without
gravity that comes to rest."""


def follow_flow(particles: Particles, grid: Grid, gravity: np.ndarray, first: list[float | None]) -> None:
    """Set c = √(2 e) / mach of every material that is to follow the flow; ``first`` holds c at the start.

    c changes as fast as the material falls, slowly against the sound, so that J follows it at the pressure
    that the flow needs.
    """
    if all(group.mach is None for group in particles.groups):
        return
    fastest = math.sqrt(2 * largest_energy(particles, grid, gravity))
    for group, at_start in zip(particles.groups, first, strict=True):
        if group.mach is not None and at_start is not None:
            group.sound_speed = max(fastest / group.mach, SLOWEST * at_start)


def largest_energy(particles: Particles, grid: Grid, gravity: np.ndarray) -> float:
    """Largest energy of a particle, of its speed and of the height of its box above the lowest one, J/kg.

    Along a periodic axis the work of gravity has no potential.
    """
    downwards = np.where(grid.periodic, 0.0, gravity)
    potential, of_box = -particles.position @ downwards, particles.box @ np.abs(downwards)
    kinetic = 0.5 * np.einsum("pi,pi->p", particles.velocity, particles.velocity)
    return float((potential + of_box + kinetic).max() - (potential - of_box).min())


def mach_number(particles: Particles, largest_speed: float) -> float:
    """Largest speed over the slowest sound; zero where no material has an equation of state."""
    speeds = [group.sound_speed for group in particles.groups if group.law.uses_equation_of_state]
    return max((largest_speed / speed for speed in speeds if speed is not None), default=0.0)
