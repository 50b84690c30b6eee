"""Volumetric treatments with nothing wrong with them, and some with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import VolumetricTreatment


class Half(Sound, VolumetricTreatment):
    """Half of the field and half of its average, which has nothing wrong with it."""

    def average(self, ops, field):
        return (field + ops.average(field)) / 2


class ByMass(Sound, VolumetricTreatment):
    """Averaged by mass and not by volume: not symmetric in the volumes once they differ."""

    def average(self, ops, field):
        return ops.average(field * np.linspace(0.5, 1.5, len(field)))


class Larger(Sound, VolumetricTreatment):
    """Makes all of it a tenth larger."""

    def average(self, ops, field):
        return 1.1 * ops.average(field)


class OneSided(Sound, VolumetricTreatment):
    """Keeps a constant but is not symmetric."""

    def average(self, ops, field):
        return np.roll(field, 1)


class WritesItsInput(Sound, VolumetricTreatment):
    def average(self, ops, field):
        field[:] = ops.average(field)
        return field


class WholeNumbers(Sound, VolumetricTreatment):
    def average(self, ops, field):
        return np.rint(field).astype(int)


class Nothing(Sound, VolumetricTreatment):
    def average(self, ops, field):
        pass


class DrawsApart(Half):
    def relaxation_rate(self, ops):
        return -1.0
