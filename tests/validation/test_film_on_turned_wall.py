"""A film on a wall that is turned against the grid: the exact profile."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from bands import above, below, close_to
from clock import advance_to
from fluids import CONCRETE
from turned import axes, filled, lattice
from wall_scenes import FRESH, G, grid, plane

pytestmark = pytest.mark.section(6)
HEIGHT, SLOPE = 0.05, math.radians(20)
LONG = 1.2
"""Length of a slab, m, whose ends do not matter: at 10 cells the profile is wrong by 0.9 %, and with 0.6 m by
2.3 %, on a wall along the grid as well."""


@cache
def film(degrees: float, cells: int, length: float, time: float = 0.3, sound: float = 20.0):
    """A slab of section 2's concrete on a plane turned against the grid, as it flows at a time.

    Gravity is turned with the plane, so that all angles are one film. The slab has ends, which are still far
    from its middle.

    Returns:
        Speed in the middle, m/s, (n,), and distance from the plane, m, (n,).
    """
    cell, (along, normal) = HEIGHT / cells, axes(degrees)
    origin = np.array([0.103, 0.051])
    gravity = G * (math.sin(SLOPE) * along - math.cos(SLOPE) * normal)
    corners = origin + np.array([a * along + b * normal for a in (0, length + 0.1) for b in (0, 0.1)])

    def in_slab(a, b):
        return (a > 0) & (a < length) & (b > 0) & (b < HEIGHT)

    sample = lattice(cell / 2, in_slab, origin, degrees, reach=length)
    simulation = filled(
        {
            "until": 1.0,
            "gravity": gravity.tolist(),
            "grid": grid(cell, np.minimum(corners.min(axis=0), 0), corners.max(axis=0) + 0.02),
            "walls": {"slope": plane(origin, normal, "stick")},
            "bodies": [{"material": {**FRESH, "sound_speed": sound}}],
        },
        sample,
    )
    advance_to(simulation, time)
    p = simulation.particles
    away = p.position + simulation.grid.lower - origin
    a, b, speed = away @ along, away @ normal, p.velocity @ along
    middle = np.abs(a / length - 0.5) < 0.08
    return speed[middle], b[middle]


def film_error(speed, b, cells):
    """Speed of the surface over the exact one, and the relative L2 error of the profile."""
    drive = CONCRETE.density * G * math.sin(SLOPE)
    exact = CONCRETE.speed(drive, HEIGHT, b)
    top = b > HEIGHT * (1 - 1 / cells)
    surface = speed[top].mean() / CONCRETE.speed(drive, HEIGHT, np.array([HEIGHT]))[0]
    return surface, math.sqrt(((speed - exact) ** 2).sum() / (exact**2).sum())


def hold_film(validate, degrees, length, sound=20.0):
    speed, b = film(degrees, 10, length, sound=sound)
    surface, error = film_error(speed, b, 10)
    name = f"Film of 20° on a wall turned by {degrees:g}°"
    validate(f"{name}: speed of the surface over the exact one", surface, close_to(1.0, rel=0.03))
    validate(f"{name}: profile, L2 error", error, below(0.04, "0"))
    drive, z = CONCRETE.density * G * math.sin(SLOPE), np.linspace(0, HEIGHT, 200)
    chart = validate.figure(
        "film_on_turned_wall", "Film on a wall that is turned against the grid", x="u (mm/s)",
        y="distance from the wall (mm)",
    )  # fmt: skip
    chart.reference("exact", 1e3 * CONCRETE.speed(drive, HEIGHT, z), 1e3 * z)
    chart.points(f"{degrees:g}°, 10 cells", 1e3 * speed, 1e3 * b)


def test_film_on_a_turned_wall(validate):
    hold_film(validate, 9.46, 0.5, sound=10.0)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [9.46, 30.0])
def test_long_film_on_a_turned_wall(validate, degrees):
    hold_film(validate, degrees, LONG)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [9.46, 30.0])
def test_order_of_a_film_on_a_turned_wall(validate, degrees):
    coarse, fine = (film_error(*film(degrees, n, LONG), n)[1] for n in (5, 10))
    name = f"Film on a wall turned by {degrees:g}°: observed order, 5 to 10 cells"
    validate(name, math.log2(coarse / fine), above(1.0))
