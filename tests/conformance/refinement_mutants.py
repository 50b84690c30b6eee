"""A refinement with nothing wrong with it, and some with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import Refinement


class Halves(Sound, Refinement):
    """A box that is longer than a cell is halved, down to a quarter of a particle."""

    def refine(self, ops):
        for axis in range(ops.dim):
            ops.split(self.chosen(ops, axis), axis)

    def chosen(self, ops, axis):
        return (ops.sides()[:, axis] > 1) & (ops.portion() >= 0.5)


class Joins(Halves):
    """And pieces are merged again."""

    def refine(self, ops):
        super().refine(ops)
        ops.merge(self.pairs(ops))

    def pairs(self, ops):
        return ops.nearest_pairs(1.0)


class Endless(Halves):
    """However small the pieces are."""

    def chosen(self, ops, axis):
        return ops.sides()[:, axis] > 1


class Everything(Halves):
    """Long or not."""

    def chosen(self, ops, axis):
        return ops.portion() >= 0.5


class CutsAll(Halves):
    """To half of a cell and less, by doing so to what is not long."""

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
