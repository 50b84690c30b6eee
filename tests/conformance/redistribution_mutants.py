"""A correct redistribution, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import Redistribution


class Spread(Sound, Redistribution):
    """Correct: δx = -γ̇ dt h² ∇κ."""

    def is_due(self, shear):
        return shear > 0.05

    def redistribute(self, ops, time):
        ops.shift(self.displacement(ops, time))

    def displacement(self, ops, time):
        h, places = ops.places.spacing, ops.places
        departure = np.maximum(places.crowding() - 1, 0)
        return -(time * h * h) * ops.shear_rate()[:, None] * places.slope_at_particles(departure)


class Attracts(Spread):
    """Fault: moves particles to where there are many."""

    def displacement(self, ops, time):
        return -3 * super().displacement(ops, time)


class Settles(Spread):
    """Fault: moves particles downwards."""

    def displacement(self, ops, time):
        found = np.zeros_like(super().displacement(ops, time))
        found[:, -1] = -0.01 * ops.places.spacing * ops.shear_rate()
        return found


class NeverRests(Spread):
    """Fault: acts at a fixed rate, also without shear."""

    def displacement(self, ops, time):
        return -(time * ops.places.spacing**2) * ops.places.slope_at_particles(ops.places.crowding())


class AlwaysDue(Spread):
    def is_due(self, shear):
        return True


class Perhaps(Spread):
    def is_due(self, shear):
        return shear


class Swells(Spread):
    """Fault: increases every volume by a thousandth each time."""

    def redistribute(self, ops, time):
        ops.scale_volume_ratio(np.full(len(ops.shear_rate()), 1.001))


class Heavier(Spread):
    """Fault: weights of 1.1 in the internal force."""

    def redistribute(self, ops, time):
        ops.weigh(np.full(len(ops.shear_rate()), 1.1))


class ByChance(Spread):
    """Fault: moves particles at random, so that runs cannot be repeated."""

    def displacement(self, ops, time):
        found = super().displacement(ops, time)
        return found + 0.01 * ops.places.spacing * np.random.default_rng().standard_normal(found.shape)


class NoNumber(Spread):
    def displacement(self, ops, time):
        return np.nan * super().displacement(ops, time)


class OneTooFew(Spread):
    def displacement(self, ops, time):
        return super().displacement(ops, time)[:-1]


class WholeNumbers(Spread):
    def displacement(self, ops, time):
        return np.rint(super().displacement(ops, time)).astype(int)
