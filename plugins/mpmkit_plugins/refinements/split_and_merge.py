"""Particles that are drawn out are split, and pieces that come together are merged."""

from mpmkit.contracts import Refining, hookimpl

from .split import Split

WHOLE = 1.0
"""Portion of a particle of the start that a merged one has at most."""


class SplitAndMerge(Split):
    """As ``split``; and where a cell has more particles than a full one at the start, pieces are merged.

    Pairs of pieces that are together no more than one particle of the start, nearest first, until there are
    none or the cell has no more than a full one. What is then left in a cell that has more are pieces of
    which no two fit into one: k of them are more than (k - 1)/2 particles of the start. The portions of all
    add up to the number n at the start, so that there are at most 2 n particles and one full cell for each
    cell that the material is in.
    """

    name = "split-and-merge"
    api_version = 2
    citation = (
        "after Vacondio, Rogers, Stansby, Mignosa & Feldman, "
        "Comput. Methods Appl. Mech. Eng. 256 (2013) 132-148"
    )

    def refine(self, ops: Refining) -> None:
        super().refine(ops)
        while len(pairs := ops.nearest_pairs(WHOLE)):
            ops.merge(pairs)


@hookimpl
def mpmkit_refinements():
    return [SplitAndMerge]
