"""A disc that is squeezed between two plates that it sticks to, against lubrication and limit analysis.

Newtonian: the disc settles into Stefan's flow as a wave along its radius dies down. With a density of
5e4 kg/m³ this takes the shortest time: 6 μ/(h² ρ) is then 0.9 of 2.405 c/R, from which on the wave does not
swing. ρ v h/μ is 0.005, so that inertia adds a thousandth, and ρ c² = 1.5 MPa is 500 times the pressure of
3 kPa. Bingham: ρ c² = 2 MPa is 200 times the pressure of 10 kPa, and a viscosity of 0.01 Pa s adds 1 %.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from accurate_setup import bingham
from bands import close_to
from squeeze import RADIUS, squeeze

pytestmark = pytest.mark.section(6)
VISCOSITY, YIELD = 50.0, 500.0


def radius(height, gap):
    """Radius, m, at this gap, m, of a disc with ``RADIUS`` at the height, m, of the start."""
    return RADIUS * np.sqrt(height / gap)


@pytest.mark.parametrize(
    ("upper", "lower"), [("plane", "face"), pytest.param("cylinder", "plane", marks=pytest.mark.slow)]
)
def test_newtonian_disc_is_squeezed(validate, upper, lower):
    """F = 3π μ R⁴ v/(2 h³), Stefan; 11.8 N at 5 mm, where the disc is 50 mm wide."""
    height, speed, density = 0.005, 1e-3, 5e4
    material = {
        "law": "newtonian", "viscosity": VISCOSITY, "density": density,
        "sound_speed": math.sqrt(1.5e6 / density),
    }  # fmt: skip
    force, gap = squeeze(material, height, speed, 8, [0.0, 0.026, 0.03], upper, lower)
    exact = 1.5 * math.pi * VISCOSITY * radius(height, gap[-1]) ** 4 * speed / gap[-1] ** 3
    name = f"Newtonian disc squeezed at 1 mm/s, 8 cells, upper plate a {upper}, lower a {lower}"
    validate(f"{name}: force over Stefan's", force[-1] / exact, close_to(1.0, rel=0.05))


@cache
def yielding(height, cells=8):
    """Mean force on the plate, N, of a Bingham disc, and the disc's radius and the gap then, m."""
    density = 5e3
    material = bingham(YIELD, 0.01, density=density, sound_speed=math.sqrt(2e6 / density))
    times = [0.0, 0.015, 0.03]
    force, gap = squeeze(material, height, 2e-3, cells, times)
    return force[-1], radius(height, gap[-1]), gap[-1]


def friction(r, h):
    """Force from friction on the plates alone, N: 2π τ0 R³/(3h), from lubrication theory."""
    return 2 * math.pi * YIELD * r**3 / (3 * h)


@pytest.mark.slow
@pytest.mark.xfail(
    reason="32 % above at 5 mm, 52 % at 10 mm, 8 cells: lubrication leaves out what stretches the disc, up to"
    " √3 π τ0 R², 26 and 52 %, and points of stress are a quarter of a cell off the plate, 7 %",
    strict=True,
)
@pytest.mark.parametrize("height", [0.005, 0.01])
def test_bingham_disc_is_squeezed_as_in_lubrication(validate, height):
    """F = 2π τ0 R³/(3h): 26.2 N at 5 mm, 13.1 N at 10 mm."""
    force, r, h = yielding(height)
    name = f"Bingham disc squeezed slowly, {1e3 * height:g} mm, 8 cells"
    validate(f"{name}: force over that of lubrication", force / friction(r, h), close_to(1.0, rel=0.1))


@pytest.mark.parametrize("height", [pytest.param(0.005, marks=pytest.mark.slow), 0.01])
def test_bingham_disc_is_squeezed(validate, height):
    """Force from friction on the plates and from the stretching of the disc, √3 π τ0 R².

    This is the upper bound of limit analysis with the field v = (r/2, -z) v/h. The true force is a few per
    cent less: in plane strain the second part of Prandtl's solution is 3/4 of that of this bound.
    """
    force, r, h = yielding(height)
    bound = friction(r, h) + math.sqrt(3) * math.pi * YIELD * r**2
    name = f"Bingham disc squeezed slowly, {1e3 * height:g} mm, 8 cells"
    validate(f"{name}: force over that of friction and stretching", force / bound, close_to(1.0, rel=0.1))
