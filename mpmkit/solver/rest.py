"""Fluids at rest in a tank or a channel start with hydrostatic pressure.

If gravity starts suddenly, the pressure of a column oscillates between 0 and 2 ρ g (H - z) with the period
4 H/c; a thin fluid damps this far too slowly. A fluid that does not reach from wall to wall cannot start with
hydrostatic pressure; a message then says how long its pressure oscillates.
"""

from __future__ import annotations

import math

import numpy as np

from ..case.model import Case
from ..kernels.nodes import OPEN
from .grid import Grid
from .particles import Group, Particles

CLOSE = 1e-6
"""Largest gap, in cells, between a body and a wall or another body that counts as rounding."""
LEAST_RATIO = 0.5
"""Least volume ratio for which the equation of state is evaluated."""
HALVINGS = 50


def put_under_weight(case: Case, grid: Grid, particles: Particles) -> bool:
    """Give particles at rest the volume ratio of hydrostatic pressure, p J = g Σ (mass above)/area.

    This is done only if it is a state of rest: fluids without velocity in horizontal layers that fill the
    domain from wall to wall, or over a whole period, on a closed face in the direction of gravity. Positions
    are not changed; they are those of an incompressible liquid. J p, and not p, balances the weight at the
    nodes, because forces are mapped with the volumes J V0.

    Returns:
        Whether the particles were changed.
    """
    axis = _vertical(case, grid)
    fluid = all(group.law.uses_equation_of_state for group in particles.groups)
    if axis is None or not fluid or particles.velocity.any():
        return False
    weight = _weight_above(case, grid, particles, axis)
    if weight is None:
        return False
    ratio = np.empty_like(weight)
    for group in particles.present_groups:
        found = ratio_under(group, weight[group.part])
        if found is None:
            return False
        ratio[group.part] = found
    particles.volume_ratio[:] = ratio
    particles.volume[:] = ratio * particles.initial_volume
    for group in particles.present_groups:
        particles.pressure[group.part] = group.pressure(ratio[group.part])
    return True


def _vertical(case: Case, grid: Grid) -> int | None:
    """The axis along which gravity presses on a closed face, if all other axes are closed or periodic."""
    gravity = np.where(grid.periodic, 0.0, case.gravity_at_start)
    axes = np.flatnonzero(gravity)
    if len(axes) != 1:
        return None
    axis = int(axes[0])
    closed = grid.faces != OPEN
    floor = closed[axis, 0 if gravity[axis] < 0 else 1]
    return axis if floor and np.delete(closed, axis, axis=0).all() else None


def _weight_above(case: Case, grid: Grid, particles: Particles, axis: int) -> np.ndarray | None:
    """g Σ (mass above)/area at every particle, Pa; None if the bodies are not horizontal layers."""
    p, across = particles, [a for a in range(grid.dim) if a != axis]
    pull = float(case.gravity_at_start[axis])
    slack = CLOSE * grid.cell_size
    height = p.position[:, axis] if pull < 0 else grid.extent[axis] - p.position[:, axis]
    area = np.prod([grid.extent[a] for a in across])
    if case.space_.radial:
        area = np.pi * grid.extent[0] ** 2
    layers = []  # bottom, top, mass per area and height, and particles of every body
    for body in np.unique(p.body):
        of_body = p.body == body
        low = (p.position - p.half_size)[of_body].min(axis=0)
        high = (p.position + p.half_size)[of_body].max(axis=0)
        if (low[across] > slack).any() or (high[across] < grid.extent[across] - slack).any():
            return None
        half = p.half_size[of_body, axis]
        bottom, top = (height[of_body] - half).min(), (height[of_body] + half).max()
        # If the height of a body is not a whole number of rows, the error is at most one row.
        filled = p.initial_volume[of_body].sum() / area
        if abs(filled - (top - bottom)) > 2 * half.max():
            return None
        layers.append((bottom, top, p.mass[of_body].sum() / (area * (top - bottom)), of_body))
    layers.sort(key=lambda layer: layer[0])
    weight, above, ceiling = np.zeros(len(p)), 0.0, None
    for bottom, top, density, of_body in reversed(layers):
        if ceiling is not None and abs(top - ceiling) > slack:
            return None
        weight[of_body] = above + abs(pull) * density * (top - height[of_body])
        above += abs(pull) * density * (top - bottom)
        ceiling = bottom
    return weight if ceiling is not None and abs(ceiling) < slack else None


def swinging(case: Case, grid: Grid, particles: Particles) -> str | None:
    """A warning about a fluid that stands on a floor and starts without pressure; None if there is none.

    The first mode of a column of height h has the wave number k = π/(2 h) and the period 4 h/c; viscosity
    damps it at the rate 2/3 mu k²/rho. Solids are left out: their sound speed is physical, and they really
    oscillate.
    """
    gravity = np.where(grid.periodic, 0.0, case.gravity_at_start)
    axis = int(np.argmax(np.abs(gravity)))
    if not gravity[axis] or grid.faces[axis, 0 if gravity[axis] < 0 else 1] == OPEN:
        return None
    periods, seconds = [], []
    for group in particles.groups:
        if not group.law.uses_equation_of_state or not group.sound_speed:
            continue
        height = _height_on_floor(grid, particles, group, axis, upwards=gravity[axis] > 0)
        if height > 0:
            periods.append(4 * height / group.sound_speed)
            viscosity = group.law.largest_viscosity(case.scale.rate)
            damped = 6 * group.density * height**2 / (math.pi**2 * viscosity) if viscosity > 0 else math.inf
            seconds.append(min(damped, case.end))
    if not periods:
        return None
    slowest = int(np.argmax(seconds))
    period, lasts = periods[slowest], seconds[slowest]
    count = max(1, round(lasts / period))
    how_long = "to the end" if lasts >= case.end else "until viscosity has damped it, at the earliest"
    return (
        "gravity acts suddenly on a fluid that begins without pressure: its pressure oscillates between "
        f"about 0 and twice that of its weight, with a period of about 4 h/c = {period:.2g} s, {how_long} "
        f"({count} {'period' if count == 1 else 'periods'}, {lasts:.2g} s); take means over a few periods"
    )


def _height_on_floor(grid: Grid, p: Particles, group: Group, axis: int, upwards: bool) -> float:
    """Height, m, of the tallest body of a material at rest on a floor; 0 if there is none."""
    tallest = 0.0
    body = p.body[group.part]
    for number in np.unique(body):
        of_body = np.flatnonzero(body == number) + group.part.start
        if p.velocity[of_body].any():
            continue
        low = (p.position - p.half_size)[of_body, axis].min()
        high = (p.position + p.half_size)[of_body, axis].max()
        gap = grid.extent[axis] - high if upwards else low
        if gap < grid.cell_size / 2:
            tallest = max(tallest, float(high - low))
    return tallest


def ratio_under(group: Group, weight: np.ndarray) -> np.ndarray | None:
    """J at which p J equals a given weight, by bisection; None if there is no such J."""
    low, high = np.full(len(weight), LEAST_RATIO), np.ones(len(weight))
    if not (group.pressure(low) * low >= weight).all():
        return None
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        heavy = group.pressure(middle.copy()) * middle >= weight
        low, high = np.where(heavy, middle, low), np.where(heavy, high, middle)
    return (low + high) / 2
