"""Correct hat functions and splines, and mutants of them with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import ShapeFunction


class Hats(Sound, ShapeFunction):
    """Correct: linear hat functions."""

    support = 2
    smooth = False

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        cell = np.floor(position / cell_size)
        into = position / cell_size - cell
        base[:] = cell
        weight[..., 0], weight[..., 1] = 1 - into, into
        gradient[..., 0], gradient[..., 1] = -1 / cell_size, 1 / cell_size

    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop):
        self.fill_axis(radius, half_size, cell_size, base, weight, gradient)
        hoop[:] = weight / radius[:, None]

    def fill_axis(self, radius, half_size, cell_size, base, weight, gradient):
        one = (slice(None), None)
        self.fill(radius[one], half_size[one], cell_size, base[one], weight[one], gradient[one])


class Splines(Hats):
    """Correct: quadratic B-splines."""

    support = 3
    smooth = True

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        base[:] = np.floor(position / cell_size - 0.5)
        x = position / cell_size - base - 1
        weight[..., 0], weight[..., 1], weight[..., 2] = (0.5 - x) ** 2 / 2, 0.75 - x**2, (0.5 + x) ** 2 / 2
        gradient[..., 0], gradient[..., 1], gradient[..., 2] = x - 0.5, -2 * x, x + 0.5
        gradient /= cell_size


class WeightByDifference(Splines):
    """Fault: the last weight is 1 minus the others, and so has their rounding error."""

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        weight[..., 2] = np.maximum(1 - weight[..., 0] - weight[..., 1], 0.0)


class GradientOffByACell(Hats):
    """Fault: the gradients of the nodes of the next cell."""

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        gradient[:] = np.roll(gradient, 1, axis=-1)


class BaseOffByACell(Hats):
    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        base += 1


class TwiceTheGradient(Hats):
    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        gradient *= 2


class GradientPerCell(Hats):
    """Fault: gradients not divided by the cell size."""

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        gradient *= cell_size


class WeightsSwapped(Hats):
    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        weight[:] = weight[..., ::-1].copy()


class TooLight(Hats):
    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        weight *= 0.999


class NearestNode(Hats):
    """Fault: all weight on the nearest node, with a gradient that does not fit."""

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        weight[:] = np.rint(weight)


class SaysItIsSmooth(Hats):
    smooth = True


class FirstAxisOnly(Hats):
    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position[:, :1], half_size, cell_size, base[:, :1], weight[:, :1], gradient[:, :1])


class TooFar(Hats):
    """Fault: the first of four nodes is two cells below the cell of the particle."""

    support = 4

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        weight[:], gradient[:] = 0.0, 0.0
        super().fill(position, half_size, cell_size, base, weight[..., 2:], gradient[..., 2:])
        base -= 2


class LocalLattice(Hats):
    """Fault: counts cells from the lowest particle of the batch."""

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position - position.min(), half_size, cell_size, base, weight, gradient)


class NoHoop(Hats):
    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop):
        self.fill_axis(radius, half_size, cell_size, base, weight, gradient)
        hoop[:] = 0.0


class HoopOfTheCell(Hats):
    """Fault: the hoop term is N over the cell size instead of N/r."""

    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop):
        self.fill_axis(radius, half_size, cell_size, base, weight, gradient)
        hoop[:] = weight / cell_size


class RadialTablesOfNobody(Hats):
    """Fault: does not write the radial tables, so that they keep old values."""

    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop):
        hoop[:] = 1 / radius[:, None]


class Lopsided(Hats):
    """Fault: weights that are not symmetric under reflection."""

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base, weight, gradient)
        weight[..., 1] = weight[..., 1] ** 2
        weight[..., 0] = 1 - weight[..., 1]


class UnknownDomain(Hats):
    @property
    def particle_domain(self):
        return "stretched"


class NewBase(Hats):
    """Fault: assigns a new array to the name of its base instead of writing in place."""

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        super().fill(position, half_size, cell_size, base.copy(), weight, gradient)


class NewHoop(Hats):
    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop):
        super().fill_radial(radius, half_size, cell_size, base, weight, gradient, hoop.copy())
