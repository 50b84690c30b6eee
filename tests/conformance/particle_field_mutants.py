"""A particle field with nothing wrong with it, and some with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import ParticleField


class Momentum(Sound, ParticleField):
    """m |v|"""

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
    """Of the particle before it in memory."""

    def values(self, scene):
        return np.roll(super().values(scene), 1)


class Heavier(Momentum):
    """Writes to the scene."""

    def values(self, scene):
        scene.mass[:] *= 2
        return super().values(scene)
