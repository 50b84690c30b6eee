"""The pressure of a Bingham fluid in a tube: Buckingham & Reiner."""

import pytest

from mpmkit.rheology.tubes import tube_gradient


def test_a_newtonian_fluid_needs_the_pressure_of_poiseuille():
    assert tube_gradient(0.0125, 0.1, 0.0, 10.0) == pytest.approx(8 * 10 * 0.1 / 0.0125**2, rel=1e-12)


def test_a_plug_needs_what_the_wall_holds():
    assert tube_gradient(0.01, 1e-9, 100.0, 1.0) == pytest.approx(2 * 100 / 0.01, rel=1e-3)


@pytest.mark.parametrize(("stress", "speed"), [(200.0, 0.1), (50.0, 1.0), (1000.0, 0.01)])
def test_it_carries_the_flow_for_which_it_was_found(stress, speed):
    radius, viscosity = 0.0125, 10.0
    gradient = tube_gradient(radius, speed, stress, viscosity)
    part = 2 * stress / (gradient * radius)
    mean = gradient * radius**2 / (8 * viscosity) * (1 - 4 / 3 * part + part**4 / 3)
    assert mean == pytest.approx(speed, rel=1e-9)


def test_the_number_of_the_pump():
    assert tube_gradient(0.0125, 0.1, 200.0, 10.0) * 0.2 == pytest.approx(18.7e3, rel=2e-3)
