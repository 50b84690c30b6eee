"""A correct source, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import Mouth, Source


class Tap(Sound, Source):
    """Correct: a section in the middle of the scene that opens slowly, from 1 s to 5 s."""

    def mouth(self, space, domain):
        half = [0.1] * (space.dim - 1) + [0.0]
        return Mouth(tuple([0.1] * (space.dim - 1) + [0.5]), tuple(half), space.dim - 1, -1)

    def pushed(self, t, area, density):
        return 0.1 * min(max(t - 1.0, 0.0), 4.0) ** 2

    def fastest(self, t0, t1, area, density):
        return 0.2 * min(max(t1 - 1.0, 0.0), 4.0)

    def spell(self, area, density):
        return 1.0, 5.0


class Nowhere(Tap):
    def problem(self, space, domain):
        return "there is no room"


class SaysNothing(Tap):
    def problem(self, space, domain):
        return " " if space.radial else None


class NoMouth(Tap):
    def mouth(self, space, domain):
        return 0.1, 0.1


class Thick(Tap):
    def mouth(self, space, domain):
        return Mouth((0.1,) * space.dim, (0.1,) * space.dim, 0, 1)


class Sideways(Tap):
    def mouth(self, space, domain):
        return Mouth((0.1,) * space.dim, (0.1,) * (space.dim - 1) + (0.0,), space.dim, 1)


class Unsigned(Tap):
    def mouth(self, space, domain):
        return Mouth((0.1,) * space.dim, (0.1,) * (space.dim - 1) + (0.0,), space.dim - 1, 0)


class Sucks(Tap):
    def pushed(self, t, area, density):
        return super().pushed(t, area, density) * (1 if t < 3 else 0.5)


class Idle(Tap):
    def pushed(self, t, area, density):
        return 0.0


class TooEarly(Tap):
    def pushed(self, t, area, density):
        return 0.1 * t

    def fastest(self, t0, t1, area, density):
        return 0.1


class Endless(Tap):
    def pushed(self, t, area, density):
        return 0.1 * max(t - 1.0, 0.0) ** 2


class EndsFirst(Tap):
    def spell(self, area, density):
        return 5.0, 1.0


class AText(Tap):
    def pushed(self, t, area, density):
        return "0.1"


class Slower(Tap):
    def fastest(self, t0, t1, area, density):
        return 0.1 * min(max(t1 - 1.0, 0.0), 4.0)


class Runs(Tap):
    """Fault: the mouth moves faster than ``fastest`` says."""

    def moved(self, t):
        return np.array([5.0 * t, 0.0])


class Counts(Tap):
    asked: list = []

    def pushed(self, t, area, density):
        self.asked.append(t)
        return super().pushed(t, area, density) * (1 + 1e-6 * len(self.asked))
