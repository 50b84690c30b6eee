"""Splitting of particles with long boxes, as long as more particles are needed."""

import numpy as np

from mpmkit.contracts import Refinement, Refining, hookimpl

LONG = 1 + 1e-9
"""Side of a box, in cells, above which it is split: a longer one leaves cells without a particle."""
SOON = 0.8
"""Side, in cells, above which a box is also split if another one is too long, so that arrays grow rarely."""
MIXED = 2.0
"""Side, in cells, above which a box is cut if it cannot be split because the cells of its halves are full."""
SMALLEST = 1 / 8
"""Least portion (share of an initial particle) of a half in a cell with enough particles."""


class Split(Refinement):
    """A box that is longer than a cell along an axis is halved, unless there are enough small particles.

    The portions of all particles add up to their number n at the start, so there are never more than 8 n
    particles with a portion of an eighth or more. Smaller halves are made only in cells with fewer particles
    than a full cell has at the start. A thread that is stretched very far needs them. Their number is limited
    to that of two full cells for each cell with material. Elsewhere, a particle too small to be split gets
    its box cut to a cell when it is two cells long: so much strain has mixed it with other particles, which
    fill the space.
    """

    name = "split"
    api_version = 2
    citation = "after Tan & Nairn, Comput. Methods Appl. Mech. Eng. 191 (2002) 2123-2137"

    def refine(self, ops: Refining) -> None:
        for axis in range(ops.dim):
            side = ops.sides()[:, axis]
            if side.max() > LONG:
                large, small = ops.portion() >= 2 * SMALLEST, ops.portion() < 2 * SMALLEST
                needed = _affordable(ops, ops.with_room((side > SOON) & small, axis))
                ops.cut(small & ~needed & (side > MIXED), axis)
                ops.split((side > SOON) & large | needed, axis)


def _affordable(ops: Refining, needed: np.ndarray) -> np.ndarray:
    """The needed splits; none if there were then more small particles than two full cells for each cell."""
    small = np.count_nonzero(ops.portion() < SMALLEST) + 2 * np.count_nonzero(needed)
    return needed & (small <= 2 * (ops.full() / ops.count()).sum())


@hookimpl
def mpmkit_refinements():
    return [Split]
