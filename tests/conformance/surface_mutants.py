"""A correct surface, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import Surface


class Rising(Sound, Surface):
    """Correct: a sphere of 0.4 m, in 2-D and 3-D, that oscillates by 0.1 m."""

    def distance(self, x, t):
        offset = x - self.centre(x.shape[1], t)
        length = np.linalg.norm(offset, axis=1)
        return length - 0.4, offset / length[:, None]

    def velocity(self, x, t):
        return np.broadcast_to(self.rate(x.shape[1], t), x.shape).copy()

    def fastest(self, t0, t1):
        return 0.3

    def centre(self, dim, t):
        return 0.1 * np.sin(3 * t) * np.eye(dim)[-1]

    def rate(self, dim, t):
        return 0.3 * np.cos(3 * t) * np.eye(dim)[-1]


class NormalIntoTheWall(Rising):
    def distance(self, x, t):
        distance, normal = super().distance(x, t)
        return distance, -normal


class NotOfLengthOne(Rising):
    def distance(self, x, t):
        distance, normal = super().distance(x, t)
        return distance, 2 * normal


class Squared(Rising):
    """Fault: a level set that is not a distance."""

    def distance(self, x, t):
        distance, normal = super().distance(x, t)
        return (distance + 0.4) ** 2 - 0.16, normal


class HalfTheDistance(Rising):
    def distance(self, x, t):
        distance, normal = super().distance(x, t)
        return distance / 2, normal


class AtRest(Rising):
    """Fault: moves, but gives the velocity 0."""

    def velocity(self, x, t):
        return np.zeros_like(x)


class WrongWay(Rising):
    def rate(self, dim, t):
        return -super().rate(dim, t)


class Slower(Rising):
    def fastest(self, t0, t1):
        return 0.29


class OneNormal(Rising):
    def distance(self, x, t):
        distance, normal = super().distance(x, t)
        return distance, normal[0]


class NoNumber(Rising):
    def distance(self, x, t):
        distance, normal = super().distance(x, t)
        distance[7] = np.nan
        return distance, normal


class MovesThePoints(Rising):
    def distance(self, x, t):
        x -= self.centre(x.shape[1], t)
        length = np.linalg.norm(x, axis=1)
        return length - 0.4, x / length[:, None]


class KnowsTheOthers(Rising):
    def velocity(self, x, t):
        return super().velocity(x, t) * (1 - 0.1 * (np.arange(len(x)) % 2))[:, None]


class Perhaps(Rising):
    def present(self, t):
        return "yes"


class Nowhere(Rising):
    def problem(self, space):
        return f"no {space.name}"


class NoSentence(Rising):
    def problem(self, space):
        return 3


class Paper(Rising):
    thickness: float = -1.0
