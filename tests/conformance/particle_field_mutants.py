"""A correct particle field, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import ParticleField


class Momentum(Sound, ParticleField):
    """Correct: m |v|."""

    unit, long_name = "kg m/s", "momentum"

    def values(self, scene):
        return scene.mass * np.linalg.norm(scene.velocity, axis=1)


class NoUnit(Momentum):
    unit = None


class Shapeless(Momentum):
    shape = 3


class OnlySome(Momentum):
    def values(self, scene):
        return super().values(scene)[:-1]


class Whole(Momentum):
    def values(self, scene):
        return scene.number


class OneNumber(Momentum):
    def values(self, scene):
        return 1.0


class Infinite(Momentum):
    def values(self, scene):
        return np.full(len(scene.mass), np.inf)


class KnowsTheOthers(Momentum):
    """Fault: takes the value of the previous particle in memory."""

    def values(self, scene):
        return np.roll(super().values(scene), 1)


class Heavier(Momentum):
    """Fault: writes to the scene."""

    def values(self, scene):
        scene.mass[:] *= 2
        return super().values(scene)
