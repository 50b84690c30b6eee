"""The particles of a scene for a refinement; implements the contract ``Refining``."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..case.model import Case
from ..contracts import ConstitutiveLaw
from ..contracts import refinement as contract
from ..errors import PluginFault
from ..kernels.pairs import nearest_partners
from ..registry import audit
from .grid import Grid
from .merging import merge
from .particles import Particles
from .splitting import halve


def refines(author: contract.Refinement) -> bool:
    """Whether a refinement can change particles; one that does not override ``refine`` cannot."""
    return type(author).refine is not contract.Refinement.refine


class Refiner:
    """The object that a refinement reads particles from, and that splits and merges them for it.

    Requests of the refinement are checked here: PluginFault if one is not possible.

    Args:
        case: gives the refinement, and the number of particles in a full cell of each body.
        grid: its cells measure the boxes.
        particles: changed in place.
    """

    def __init__(self, case: Case, grid: Grid, particles: Particles) -> None:
        self.dim = grid.dim
        self._author = case.scheme.refinement
        self._grid, self._particles, self._radial = grid, particles, case.space_.radial
        along_axes = [body.particles_along_axes(grid.dim) for body in case.filled]
        self._full = np.array([int(np.prod(counts)) for counts in along_axes])
        self.acts = refines(self._author)

    def refine(self) -> bool:
        """Run the refinement; return whether particles were added or removed.

        Raises:
            OutOfMemory: there is not enough memory for the halves.
        """
        p = self._particles
        before = p.numbers_given, len(p)
        if self.acts:
            self._author.refine(self)
        return before != (p.numbers_given, len(p))

    # --- What there is

    @property
    def time(self) -> float:
        return self._particles.time

    def sides(self) -> np.ndarray:
        return 2 * self._particles.box / self._grid.cell_size

    def portion(self) -> np.ndarray:
        return self._particles.portion.copy()

    def count(self) -> np.ndarray:
        own, cells = _numbered(self._cells())
        return np.bincount(own, minlength=cells)[own]

    def full(self) -> np.ndarray:
        return self._full[self._particles.body]

    def _cells(self) -> np.ndarray:
        """Material, and cell along each axis, of every particle, ``(n, 1 + dim)``."""
        p = self._particles
        found = np.empty((len(p), 1 + self.dim), dtype=np.int64)
        for index, group in enumerate(p.groups):
            found[group.part, 0] = index
        np.floor(p.position / self._grid.cell_size, out=found[:, 1:], casting="unsafe")
        return found

    def with_room(self, which: np.ndarray, axis: int) -> np.ndarray:
        self._require_choice(which, axis)
        asking = np.flatnonzero(which)
        found = np.zeros(len(which), dtype=bool)
        if len(asking):
            p, own = self._particles, self._cells()
            target = own[asking].copy()
            target[:, 1 + axis] = self._cell_of_half(asking, axis)
            index, cells = _numbered(np.concatenate([own, target]))
            count, there = np.bincount(index[: len(own)], minlength=cells), index[len(own) :]
            order = np.lexsort((p.number[asking], -p.box[asking, axis], there))
            asking, there = asking[order], there[order]
            before = np.arange(len(there)) - np.searchsorted(
                there, there
            )  # rank among the particles that enter the same cell
            found[asking[count[there] + before < self.full()[asking]]] = True
        return found

    def _cell_of_half(self, which: np.ndarray, axis: int) -> np.ndarray:
        """The cell along an axis that a half of each particle enters: a neighbour cell, else its own."""
        dx, p, cells = self._grid.cell_size, self._particles, self._grid.cells[axis]
        x, offset = p.position[which, axis], p.box[which, axis] / 2
        own, low, high = (np.floor(at / dx).astype(np.int64) for at in (x, x - offset, x + offset))
        if self._grid.periodic[axis]:
            low, high = low % cells, high % cells
        else:
            low, high = np.maximum(low, 0), np.minimum(high, cells - 1)
        return np.where(low != own, low, high)

    def nearest_pairs(self, largest: float) -> np.ndarray:
        p = self._particles
        own, cells = _numbered(self._cells())
        count = np.bincount(own, minlength=cells)
        crowded = count[own] > self.full()
        for group in p.groups:
            crowded[group.part] &= _merges(group.law)
        rows = np.flatnonzero(crowded)
        if not len(rows):
            return np.empty((0, 2), dtype=np.int64)
        rows = rows[np.lexsort((p.number[rows], own[rows]))]
        first = np.append(np.flatnonzero(np.diff(own[rows], prepend=-1)), len(rows))
        partner, square = np.empty(len(rows), dtype=np.int64), np.empty(len(rows))
        nearest_partners(first, p.position[rows], p.body[rows], p.portion[rows], largest, partner, square)
        one = np.flatnonzero(partner > np.arange(len(rows)))
        one = one[partner[partner[one]] == one]
        one = one[np.lexsort((p.number[rows[one]], square[one], own[rows[one]]))]
        cell = own[rows[one]]
        before = np.arange(len(one)) - np.searchsorted(cell, cell)
        wanted = count[cell] - self.full()[rows[one]]
        one = one[before < wanted]
        return np.stack([rows[one], rows[partner[one]]], axis=1)

    # --- What is done

    def split(self, which: np.ndarray, axis: int) -> None:
        self._require_choice(which, axis)
        if which.any():
            halve(self._particles, self._grid, which, axis, self._radial and axis == 0)

    def cut(self, which: np.ndarray, axis: int) -> None:
        self._require_choice(which, axis)
        p, side = self._particles, self._grid.cell_size / 2
        cut = which & (p.box[:, axis] > side)
        p.box[cut, axis] = side
        if p.least_half_size is not None:  # the domain of the shape function has a lower limit
            p.half_size[cut, axis] = np.maximum(side, p.least_half_size[cut, axis])

    def merge(self, pairs: np.ndarray) -> None:
        self._require_pairs(pairs)
        if len(pairs):
            merge(self._particles, pairs, self._grid.cell_size, self._radial)

    # --- What is asked for

    def _require_choice(self, which: Any, axis: Any) -> None:
        """Raise PluginFault unless ``which`` is True or False for each particle, and the axis is one."""
        count = len(self._particles)
        if not isinstance(which, np.ndarray) or which.shape != (count,) or which.dtype != bool:
            found = audit.described(which) + (
                f" of {which.dtype}" if isinstance(which, np.ndarray) and which.dtype != bool else ""
            )
            raise PluginFault(
                self._author,
                f"chose particles by {found}; it must be an array of True and False of shape ({count},)",
            )
        if isinstance(axis, bool) or axis not in range(self.dim):
            raise PluginFault(self._author, f"asked for axis {axis!r}; it must be 0 to {self.dim - 1}")

    def _require_pairs(self, pairs: Any) -> None:
        """Raise PluginFault unless these are rows of particles that can be merged, each once."""
        p, author = self._particles, self._author
        whole = isinstance(pairs, np.ndarray) and pairs.dtype.kind in "iu"
        if not whole or pairs.ndim != 2 or pairs.shape[1] != 2:
            found = audit.described(pairs) + (f" of {pairs.dtype}" if isinstance(pairs, np.ndarray) else "")
            raise PluginFault(
                author, f"gave {found} as pairs to merge; it must be an array of shape (m, 2) of integers"
            )
        if not pairs.size:
            return
        if pairs.min() < 0 or pairs.max() >= len(p):
            outside = pairs.min() if pairs.min() < 0 else pairs.max()
            raise PluginFault(author, f"gave row {outside} in a pair to merge; rows are 0 to {len(p) - 1}")
        rows, times = np.unique(pairs, return_counts=True)
        if times.max() > 1:
            number = int(p.number[rows[np.argmax(times)]])
            raise PluginFault(author, f"gave particle {number} twice in pairs to merge; each may be in one")
        apart = np.flatnonzero(p.body[pairs[:, 0]] != p.body[pairs[:, 1]])
        if len(apart):
            one, other = p.number[pairs[apart[0]]]
            raise PluginFault(
                author, f"gave particles {one} and {other} as a pair to merge; they are of two bodies"
            )
        for group in p.groups:
            inside = (pairs[:, 0] >= group.part.start) & (pairs[:, 0] < group.part.stop)
            if inside.any() and not _merges(group.law):
                number = int(p.number[pairs[inside][0, 0]])
                raise PluginFault(
                    author,
                    f"gave particle {number} in a pair to merge; its law '{group.law.name}' is of a material "
                    "whose particles keep their neighbours, or needs the deformation gradient of each",
                )


def _merges(law: ConstitutiveLaw) -> bool:
    """Whether particles of a law can be merged: those of a fluid, which take each other's places.

    A deformation gradient belongs to one particle: the mean of two is that of neither.
    """
    return law.uses_equation_of_state and not law.needs_deformation_gradient


def _numbered(cells: np.ndarray) -> tuple[np.ndarray, int]:
    """Numbers of the different rows, ``(n,)``, from 0 in the order of the rows, and how many there are."""
    cells = cells - cells.min(axis=0)
    key = np.ravel_multi_index(tuple(cells.T), tuple(cells.max(axis=0) + 1))
    found, index = np.unique(key, return_inverse=True)
    return index, len(found)
