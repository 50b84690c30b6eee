"""Time in which a fluid flows out of a funnel, against closed forms and published constants."""

import math

import numpy as np
import pytest

from mpmkit.rheology.funnels import circles, flow, flow_time, rectangles

WATERLIKE = 1000.0, 0.0, 0.1
STEEP = 0.001
"""Radius of a capillary, m, in which the kinetic head is negligible."""


def tube(z):
    return circles(np.full_like(z, STEEP))


def test_constants_of_the_sections_are_those_of_the_paper():
    """Kozicki, Chou & Tiu 1966, table 1: a and b of a square, of sides 1 : 2, and of a slit."""
    _, _, a, b = rectangles(np.array([1.0, 0.5, 1e-4]), 1.0)
    np.testing.assert_allclose(a, [0.2121, 0.2439, 0.5], atol=2e-4)
    np.testing.assert_allclose(b, [0.6771, 0.7278, 1.0], atol=1e-3)


def test_a_capillary_drains_as_poiseuille_says():
    """dh/dt = -ρ g R² h/(8 μ L) in a tube as long as the head: at a constant rate."""
    time = flow_time(0.1, math.pi * STEEP**2 * 0.05, tube, *WATERLIKE)
    assert time == pytest.approx(0.05 / (1000 * 9.81 * STEEP**2 / (8 * 0.1)), rel=5e-3)


@pytest.mark.parametrize("part", [0.2, 0.5, 0.9])
def test_a_tube_of_bingham_fluid_flows_as_buckingham_and_reiner_say(part):
    """Q = π R⁴ G/(8 μ) (1 - 4/3 φ + φ⁴/3), φ = τ0/τ_w."""
    wall = 1000 * 9.81 * STEEP / 2
    found = flow(0.1, 0.01, tube(np.zeros(10)), (1000.0, part * wall, 0.1))
    newtonian = math.pi * STEEP**4 * 1000 * 9.81 / 0.8
    assert found == pytest.approx(newtonian * (1 - 4 * part / 3 + part**4 / 3), rel=5e-3)


def test_a_slit_of_bingham_fluid_flows_as_its_profile_says():
    """Q = W H³ G/(12 μ) (1 - 3/2 φ + φ³/2)."""
    gap, part = 0.001, 0.5
    sections = rectangles(np.full(10, 1e4 * gap), gap)
    wall = 1000 * 9.81 * gap / 2
    found = flow(0.1, 0.01, sections, (1000.0, part * wall, 0.1)) / (1e4 * gap)
    newtonian = gap**3 * 1000 * 9.81 / (12 * 0.1)
    assert found == pytest.approx(newtonian * (1 - 1.5 * part + part**3 / 2), rel=5e-3)


def test_nothing_flows_below_the_yield_stress():
    wall = 1000 * 9.81 * STEEP / 2
    assert flow_time(0.1, 1e-8, tube, 1000.0, 1.01 * wall, 0.1) == math.inf
    with pytest.raises(ValueError, match="holds only"):
        flow_time(0.1, 1.0, tube, *WATERLIKE)


def test_without_viscosity_the_kinetic_head_alone_is_left():
    """ρ g h = ρ (Q/A)²."""
    found = flow(0.1, 0.01, circles(np.full(10, 0.1)), (1000.0, 0.0, 1e-6))
    assert found == pytest.approx(math.pi * 0.01 * math.sqrt(9.81 * 0.1), rel=1e-3)


@pytest.mark.parametrize(("yield_stress", "time"), [(0.0, 13.1), (5.0, 13.6), (20.0, 15.5)])
def test_the_first_litre_of_a_marsh_cone(yield_stress, time):
    """Ø155 × 290 mm with a nozzle Ø10 × 60 mm, full at first, ρ 1900, 0.2 Pa s."""

    def cone(z):
        return circles(np.interp(z, [0.06, 0.35], [0.005, 0.0775]))

    assert flow_time(0.35, 1e-3, cone, 1900.0, yield_stress, 0.2) == pytest.approx(time, abs=0.05)
