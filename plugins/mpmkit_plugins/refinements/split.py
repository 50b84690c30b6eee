"""Particles that are drawn out are split, as long as there is need of them."""

import numpy as np

from mpmkit.contracts import Refinement, Refining, hookimpl

LONG = 1 + 1e-9
"""Side of a box, in cells, from which it is split: one that is longer leaves cells without a particle."""
SOON = 0.8
"""Side from which a box is split as well where another one is too long: arrays then grow rarely."""
MIXED = 2.0
"""Side from which one that finds no room is cut: its halves would lie in other cells, which are full."""
SMALLEST = 1 / 8
"""Portion of a particle of the start that a half has at least where its cell has enough particles."""


class Split(Refinement):
    """A box that is longer than a cell along an axis is halved, unless there are enough small particles.

    The portions of all particles add up to their number n at the start: there are never more than 8 n of an
    eighth or more. Smaller halves only come into cells with fewer particles than a full one has at the
    start, and in all there are at most two full cells of them for each cell with material; a thread that is
    drawn out and out needs them. Elsewhere the box of a particle that is too small to be
    split is cut to a cell when it is two cells long: what drew it out so often has mixed it with others,
    which fill the room.
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
    """What is needed; nothing if there were then more small ones than two full cells for each cell."""
    small = np.count_nonzero(ops.portion() < SMALLEST) + 2 * np.count_nonzero(needed)
    return needed & (small <= 2 * (ops.full() / ops.count()).sum())


@hookimpl
def mpmkit_refinements():
    return [Split]
