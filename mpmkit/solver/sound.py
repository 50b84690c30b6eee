"""A sound speed that follows the flow: its present speed, and the speed that it can reach."""

from __future__ import annotations

import math

import numpy as np

from .grid import Grid
from .particles import Group, Particles

SLOWEST = 0.1
"""Least sound speed relative to its initial value, as for a scene without gravity that comes to rest."""
CHANGE = 0.05
"""Largest change of ln c in the time in which sound crosses the material; a slump at Mach 0.1 needs half of
it. J changes with c at once, and the change must be slow enough for the particles to follow."""
ITERATIONS = 20
"""Steps of Newton's method, of which two or three suffice."""
ROUNDING = 1e-14


def follow_flow(
    particles: Particles,
    grid: Grid,
    gravity: np.ndarray,
    forces: np.ndarray,
    first: list[float | None],
    elapsed: float,
    more_comes: bool = False,
) -> None:
    """Move c of every material that follows the flow towards √(2 e) / mach.

    c changes slowly compared with sound waves, and at constant energy, see ``_change_sound``.

    Args:
        particles: their sound speeds, volume ratios and pressures are changed.
        grid: tells which axes are periodic.
        gravity: ``(dim,)``, m/s².
        forces: ``(dim,)``, m/s², upper bounds of what other forces are along each axis.
        first: c of each material at the start, m/s.
        elapsed: time since the last change, s.
        more_comes: whether sources will bring in more; c is then at least that of the start, which knows
            their speed and height.
    """
    if not len(particles) or all(group.mach is None for group in particles.groups):
        return
    slowest = 1.0 if more_comes else SLOWEST
    extent = np.ptp(particles.position, axis=0)
    length = float(extent.max())
    of_forces = float(forces @ np.where(grid.periodic, 0.0, extent))
    fastest = math.sqrt(2 * (largest_energy(particles, grid, gravity) + of_forces))
    for group, at_start in zip(particles.groups, first, strict=True):
        if group.mach is not None and at_start is not None:
            speed = group.sound_speed
            assert speed is not None
            wanted = max(fastest / group.mach, slowest * at_start)
            most = math.exp(CHANGE * elapsed * speed / max(length, grid.cell_size))
            _change_sound(particles, group, min(max(wanted, speed / most), speed * most))


def _change_sound(p: Particles, group: Group, speed: float) -> None:
    """Change c of a material, and set J of each particle so that its stored energy stays the same.

    A change at constant J would multiply the stored energy by the squared ratio of c, a change at constant
    pressure by its inverse: a wave with high c in compression and low c at rest would gain energy in every
    period. At constant energy, the pressure is proportional to c. J stays on its side of 1 and is found by
    Newton's method on √e, which is almost linear in J.
    """
    part, ratio = group.part, p.volume_ratio[group.part]
    wanted = np.sqrt(group.compressive_energy(ratio))
    assert group.sound_speed is not None
    found = 1 + (ratio - 1) * (group.sound_speed / speed)
    group.sound_speed = speed
    for _ in range(ITERATIONS):
        root = np.sqrt(group.compressive_energy(found))
        slope = -group.pressure(found) / (2 * np.where(root > 0, root, 1.0))
        off = np.where((root > 0) & (slope != 0), (wanted - root) / np.where(slope == 0, 1.0, slope), 0.0)
        found = np.maximum(found + off, found / 2)
        if not np.abs(off).max() > ROUNDING:
            break
    p.volume_ratio[part] = found
    p.volume[part] = found * p.initial_volume[part]
    p.pressure[part] = group.pressure(found)


def largest_energy(particles: Particles, grid: Grid, gravity: np.ndarray) -> float:
    """Largest energy of a particle, J/kg: kinetic, stored, and potential (height of its box above the lowest
    box).

    Stored energy is included because it can become motion again: an impact on a wall conserves the sum. Along
    a periodic axis the work of gravity has no potential.
    """
    downwards = np.where(grid.periodic, 0.0, gravity)
    potential, of_box = -particles.position @ downwards, particles.box @ np.abs(downwards)
    moving = 0.5 * np.einsum("pi,pi->p", particles.velocity, particles.velocity)
    for group in particles.present_groups:
        part = group.part
        stored = group.law.strain_energy(particles.kinematics(group), group.state, particles.stress[part])
        if group.law.uses_equation_of_state:
            stored = stored + group.compressive_energy(particles.volume_ratio[part])
        moving[part] += stored / group.density
    return float((potential + of_box + moving).max() - (potential - of_box).min())


def mach_number(particles: Particles, largest_speed: float) -> float:
    """Largest speed over the lowest sound speed; 0 if no material has an equation of state."""
    speeds = [group.sound_speed for group in particles.groups if group.law.uses_equation_of_state]
    return max((largest_speed / speed for speed in speeds if speed is not None), default=0.0)
