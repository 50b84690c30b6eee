"""A correct initial field, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import InitialField


class Rising(Sound, InitialField):
    """Correct: a velocity that increases with height."""

    def problem(self, space, field, shape):
        return None if field == "velocity" else "it gives a velocity"

    def at(self, start):
        return start.position[:, -1:] * np.ones(start.shape)


class Nowhere(Rising):
    def problem(self, space, field, shape):
        return "there is no room"


class SaysNothing(Rising):
    def problem(self, space, field, shape):
        return None if field == "velocity" else " "


class OneForAll(Rising):
    def at(self, start):
        return np.ones(start.shape)


class NoNumber(Rising):
    def at(self, start):
        return np.full_like(super().at(start), np.nan)


class Moves(Rising):
    def at(self, start):
        start.position[:] += 1.0
        return super().at(start)


class KnowsTheOthers(Rising):
    def at(self, start):
        return super().at(start) - start.position.mean()
