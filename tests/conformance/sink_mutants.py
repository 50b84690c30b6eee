"""A correct sink, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import Sink


class Below(Sound, Sink):
    """Correct: takes what is below 0.1 m."""

    def takes(self, x, t, domain):
        return x[:, -1] < 0.1


class Nowhere(Below):
    def problem(self, space, faces):
        return "there is no room"


class SaysNothing(Below):
    def problem(self, space, faces):
        return " " if space.radial else None


class Rows(Below):
    def takes(self, x, t, domain):
        return np.flatnonzero(super().takes(x, t, domain))


class Perhaps(Below):
    def takes(self, x, t, domain):
        return super().takes(x, t, domain).astype(float)


class Nothing(Below):
    def takes(self, x, t, domain):
        return np.zeros(len(x), dtype=bool)


class Everything(Below):
    def takes(self, x, t, domain):
        return np.ones(len(x), dtype=bool)


class Lowest(Below):
    """Fault: takes the particles below the median, so that the others matter."""

    def takes(self, x, t, domain):
        return x[:, -1] < np.median(x[:, -1])


class Pulls(Below):
    """Fault: changes the positions that it gets."""

    def takes(self, x, t, domain):
        x[:, -1] -= 0.1
        return x[:, -1] < 0.1
