"""Splitting of particles with long boxes, and merging of small particles in crowded cells."""

from mpmkit.contracts import Refining, hookimpl

from .split import Split

WHOLE = 1.0
"""Largest portion (share of an initial particle) of a merged particle."""


class SplitAndMerge(Split):
    """As ``split``; in cells with more particles than a full cell at the start, pieces are also merged.

    Pairs of pieces with a sum of portions of at most 1 are merged, nearest pairs first, until there are none,
    or the cell has no more particles than a full cell. If such a cell still has k pieces, no two of them fit
    together, so the sum of their portions is above (k - 1)/2. The portions of all particles add up to the
    number n at the start. So there are at most 2 n particles and one full cell for each cell with material.
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
