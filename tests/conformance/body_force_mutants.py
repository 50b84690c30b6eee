"""A correct body force, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import BodyForce


class Pulse(Sound, BodyForce):
    """Correct: an acceleration along the last axis that decays until 0.3 s."""

    uniform = True

    def acceleration(self, x, v, t):
        a = np.zeros_like(x)
        a[:, -1] = -2.0 * max(0.0, 0.3 - t)
        return a

    def settles(self):
        return 0.3


class Nowhere(Pulse):
    def problem(self, space):
        return "there is no room"


class SaysNothing(Pulse):
    def problem(self, space):
        return " " if space.radial else None


class OneForAll(Pulse):
    def acceleration(self, x, v, t):
        return super().acceleration(x, v, t)[0]


class Infinite(Pulse):
    def acceleration(self, x, v, t):
        return super().acceleration(x, v, t) + 1 / np.maximum(0.0, 0.5 - t) * np.array(np.inf)


class Moves(Pulse):
    """Fault: changes the positions that it gets."""

    def acceleration(self, x, v, t):
        x += 1.0
        return super().acceleration(x, v, t)


class Nothing(Pulse):
    def acceleration(self, x, v, t):
        return np.zeros_like(x)


class KnowsTheOthers(Pulse):
    uniform = False

    def acceleration(self, x, v, t):
        return x - x.mean(axis=0)


class Varies(Pulse):
    """Fault: declares itself uniform, but depends on the position."""

    def acceleration(self, x, v, t):
        return super().acceleration(x, v, t) * x


class Drags(Pulse):
    """Fault: depends on the velocity without declaring it."""

    uniform = False

    def acceleration(self, x, v, t):
        return super().acceleration(x, v, t) - v


class Changes(Pulse):
    """Fault: declares itself constant, but changes with time."""

    constant = True


class Double(Pulse):
    def mean_acceleration(self, x, v, t0, t1):
        return 2 * super().mean_acceleration(x, v, t0, t1)


class Weaker(Pulse):
    def largest(self, lower, upper, t0, t1):
        return super().largest(lower, upper, t0, t1) / 2


class Restless(Pulse):
    def settles(self):
        return 0.1


class NoPeriod(Pulse):
    def shortest_period(self):
        return 0.0
