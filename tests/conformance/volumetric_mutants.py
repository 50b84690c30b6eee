"""A correct volumetric treatment, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import VolumetricTreatment


class Half(Sound, VolumetricTreatment):
    """Correct: half of the field and half of its average."""

    def average(self, ops, field):
        return (field + ops.average(field)) / 2


class ByMass(Sound, VolumetricTreatment):
    """Fault: weights particles by their index, which is not symmetric in the volumes."""

    def average(self, ops, field):
        return ops.average(field * np.linspace(0.5, 1.5, len(field)))


class Larger(Sound, VolumetricTreatment):
    """Fault: increases all values by a tenth."""

    def average(self, ops, field):
        return 1.1 * ops.average(field)


class OneSided(Sound, VolumetricTreatment):
    """Fault: keeps a constant field but is not symmetric."""

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
