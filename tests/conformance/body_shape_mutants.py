"""A correct body shape, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import BodyShape


class Ball(Sound, BodyShape):
    """Correct: a ball of radius 0.1 m around the origin."""

    def bounds(self, space):
        lower, upper = np.full(space.dim, -0.1), np.full(space.dim, 0.1)
        if space.radial:
            lower[0] = 0.0
        return lower, upper

    def signed_distance(self, x, space):
        return np.linalg.norm(x, axis=1) - 0.1


class Nowhere(Ball):
    def problem(self, space):
        return "there is no room"


class SaysNothing(Ball):
    def problem(self, space):
        return None if space.dim == 2 else " "


class OneCorner(Ball):
    def bounds(self, space):
        return super().bounds(space)[0]


class UpsideDown(Ball):
    def bounds(self, space):
        lower, upper = super().bounds(space)
        return upper, lower


class BehindTheAxis(Ball):
    def bounds(self, space):
        return np.full(space.dim, -0.1), np.full(space.dim, 0.1)


class LeavesItsBounds(Ball):
    def bounds(self, space):
        lower, upper = super().bounds(space)
        return lower, 0.9 * upper


class Column(Ball):
    def signed_distance(self, x, space):
        return super().signed_distance(x, space)[:, None]


class NoNumber(Ball):
    def signed_distance(self, x, space):
        return np.full(len(x), np.nan)


class Moves(Ball):
    def signed_distance(self, x, space):
        x[:] += 0.01
        return super().signed_distance(x, space)


class KnowsTheOthers(Ball):
    def signed_distance(self, x, space):
        return super().signed_distance(x, space) * (1 - 0.1 * abs(x[0, 0]))


class TwiceAsFar(Ball):
    def signed_distance(self, x, space):
        return 2 * super().signed_distance(x, space)


class HalfAsFar(Ball):
    def signed_distance(self, x, space):
        return super().signed_distance(x, space) / 2


class InsideOut(Ball):
    def signed_distance(self, x, space):
        return -super().signed_distance(x, space)


class HoldsTooMuch(Ball):
    def within(self, x, space, tolerance):
        return self.signed_distance(x, space) <= 0.02


class Heavy(Ball):
    def volume(self, space):
        return 1.1 * super().volume(space)


class LosesAPart(Ball):
    def volume_between(self, lower, upper, space):
        return 0.9 * super().volume_between(lower, upper, space)

    def volume(self, space):
        return self.volume_between(*self.bounds(space), space) / 0.9
