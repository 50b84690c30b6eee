"""A correct equation of state, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import EquationOfState


class InLogarithm(Sound, EquationOfState):
    """Correct: p = -ρ c² ln J, e = ρ c² (J ln J - J + 1)."""

    def pressure(self, volume_ratio, density, sound_speed):
        return -density * sound_speed**2 * np.log(volume_ratio)

    def energy(self, volume_ratio, density, sound_speed):
        J = volume_ratio
        return density * sound_speed**2 * (J * np.log(J) - J + 1)


class WrongSign(InLogarithm):
    def pressure(self, volume_ratio, density, sound_speed):
        return -super().pressure(volume_ratio, density, sound_speed)


class TwiceAsStiff(InLogarithm):
    def pressure(self, volume_ratio, density, sound_speed):
        return 2 * super().pressure(volume_ratio, density, sound_speed)


class HalfTheEnergy(InLogarithm):
    def energy(self, volume_ratio, density, sound_speed):
        return super().energy(volume_ratio, density, sound_speed) / 2


class NegativeEnergy(InLogarithm):
    def energy(self, volume_ratio, density, sound_speed):
        return -1e9 * np.ones_like(volume_ratio)


class Pressed(InLogarithm):
    """Fault: a pressure at the initial volume."""

    def pressure(self, volume_ratio, density, sound_speed):
        return super().pressure(volume_ratio, density, sound_speed) + 1e3


class WritesItsInput(InLogarithm):
    def pressure(self, volume_ratio, density, sound_speed):
        p = super().pressure(volume_ratio, density, sound_speed)
        volume_ratio *= 0.9
        return p


class OneNumber(InLogarithm):
    def energy(self, volume_ratio, density, sound_speed):
        return 0.0


class KnowsTheOthers(InLogarithm):
    def pressure(self, volume_ratio, density, sound_speed):
        return super().pressure(volume_ratio / volume_ratio.mean() ** 1e-9, density, sound_speed)
