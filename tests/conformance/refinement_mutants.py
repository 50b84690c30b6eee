"""A correct refinement, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import Refinement


class Halves(Sound, Refinement):
    """Correct: halves boxes longer than a cell, down to a quarter of a particle."""

    def refine(self, ops):
        for axis in range(ops.dim):
            ops.split(self.chosen(ops, axis), axis)

    def chosen(self, ops, axis):
        return (ops.sides()[:, axis] > 1) & (ops.portion() >= 0.5)


class Joins(Halves):
    """Correct: also merges pieces again."""

    def refine(self, ops):
        super().refine(ops)
        ops.merge(self.pairs(ops))

    def pairs(self, ops):
        return ops.nearest_pairs(1.0)


class Endless(Halves):
    """Fault: splits pieces of any size without end."""

    def chosen(self, ops, axis):
        return ops.sides()[:, axis] > 1


class Everything(Halves):
    """Fault: splits boxes of any length."""

    def chosen(self, ops, axis):
        return ops.portion() >= 0.5


class CutsAll(Halves):
    """Fault: splits boxes that are shorter than a cell."""

    def refine(self, ops):
        ops.split(ops.sides()[:, 0] > 0.4, 0)


class ByChance(Halves):
    def chosen(self, ops, axis):
        return super().chosen(ops, axis) & (np.random.default_rng().uniform(size=len(ops.count())) > 0.5)


class OneTooFew(Halves):
    def chosen(self, ops, axis):
        return super().chosen(ops, axis)[:-1]


class Rows(Halves):
    def chosen(self, ops, axis):
        return np.flatnonzero(super().chosen(ops, axis))


class NoSuchAxis(Halves):
    def refine(self, ops):
        ops.split(ops.sides()[:, 0] > 1, ops.dim)


class WithItself(Joins):
    def pairs(self, ops):
        return np.zeros((1, 2), dtype=int)


class Decimals(Joins):
    def pairs(self, ops):
        return super().pairs(ops).astype(float)


class Beyond(Joins):
    def pairs(self, ops):
        return np.array([[0, len(ops.count())]])
