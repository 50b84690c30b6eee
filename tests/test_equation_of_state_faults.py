"""An equation of state whose pressure or energy cannot be used is named."""

from __future__ import annotations

import math

import numpy as np
import pytest
from faulty_plugins import Law, blamed, simulation

from mpmkit.contracts import (
    EquationOfState,
)


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        (lambda ratio: np.ones((len(ratio), 1)), "returned an array of shape (64, 1) from pressure"),
        (lambda ratio: 3.0, "returned a float from pressure"),
        (lambda ratio: np.full_like(ratio, np.inf), "a pressure that is not finite"),
    ],
    ids=["shape", "scalar", "infinite"],
)
def test_a_pressure_that_cannot_be_used(given, reason):
    class Bad(EquationOfState):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def pressure(self, volume_ratio, density, sound_speed):
            return given(volume_ratio)

        def energy(self, volume_ratio, density, sound_speed):
            return np.zeros_like(volume_ratio)

    assert reason in blamed("equation_of_state", Bad)


class Fluid(EquationOfState):
    """p = ρ c² (1/J - 1), with something wrong."""

    name = "of-the-tests"
    api_version = 2
    citation = "none"

    def pressure(self, volume_ratio, density, sound_speed):
        return density * sound_speed**2 * (1 / volume_ratio - 1)

    def energy(self, volume_ratio, density, sound_speed):
        return density * sound_speed**2 * (volume_ratio - 1 - np.log(volume_ratio))


def test_an_equation_of_state_that_is_sound_runs():
    made = simulation("equation_of_state", Fluid)
    made.advance()
    assert made.steps == 1


def test_an_equation_of_state_that_writes_to_what_it_may_only_read():
    class Meddler(Fluid):
        def pressure(self, volume_ratio, density, sound_speed):
            volume_ratio *= 0.999
            return super().pressure(volume_ratio, density, sound_speed)

    assert "changed 'volume_ratio', which it may only read" in blamed("equation_of_state", Meddler, 1)


@pytest.mark.parametrize(
    ("energy", "reason"),
    [
        (lambda e: e - 1e9, "gave particle 0 an energy of -1e+09 J/m³"),
        (lambda e: e + 1e9, "the energy must be that work"),
        (lambda e: 2 * e, "the energy must be that work"),
        (lambda e: -e, "the energy must be that work"),
        (lambda e: e * np.nan, "an energy that is not finite"),
        (lambda e: e.astype(complex), "returned an array of complex128 from energy"),
        (lambda e: e.astype(object), "returned an array of object from energy"),
        (lambda e: None, "returned nothing from energy; it must be an array of shape (64,)"),
    ],
    ids=["far below", "far above", "twice", "sign", "nan", "complex", "objects", "nothing"],
)
def test_an_energy_that_is_not_the_work_of_the_pressure(energy, reason):
    class Bad(Fluid):
        def energy(self, volume_ratio, density, sound_speed):
            return energy(super().energy(volume_ratio, density, sound_speed))

    assert reason in blamed("equation_of_state", Bad, steps=1)


@pytest.mark.parametrize(
    ("energy", "reason"),
    [
        (lambda stress: -1e9, "an energy of -1e+09 J/m³; a stored energy cannot be negative"),
        (lambda stress: np.full(len(stress), -1e9), "a stored energy cannot be negative"),
        (lambda stress: np.full(len(stress), np.nan), "an energy that is not finite"),
        (lambda stress: math.nan, "an energy that is not finite"),
        (lambda stress: None, "gave nothing as strain_energy; it must be a number"),
        (lambda stress: "much", "gave the text 'much' as strain_energy"),
        (lambda stress: stress.__setitem__(..., 1.0) or 0.0, "changed 'stress', which it may only read"),
    ],
    ids=["number", "array", "nan array", "nan", "nothing", "text", "meddles"],
)
def test_a_strain_energy_that_cannot_be_used(energy, reason):
    class Bad(Law):
        def strain_energy(self, motion, state, stress):
            return energy(stress)

    assert reason in blamed("law", Bad)
