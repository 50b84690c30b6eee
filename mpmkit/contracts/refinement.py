"""Contract of a refinement: which particles are split, and which are merged."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from .base import Plugin


class Refining(Protocol):
    """Access of a refinement to the scene. Arrays have an entry for each present particle, ``(n,)``.

    After ``split`` and ``merge`` the particles are different: read the arrays again.
    """

    dim: int

    @property
    def time(self) -> float:
        """Time of the scene, s."""

    def sides(self) -> np.ndarray:
        """Sides of the boxes along each axis, in cells, ``(n, dim)``."""

    def portion(self) -> np.ndarray:
        """The portion of each particle: its part of an initial particle.

        It is 1 at the start, half of the parent's after a split, and the sum of both after a merge. The sum
        over all particles is always their number at the start.
        """

    def count(self) -> np.ndarray:
        """Number of particles of the same material in the cell of each particle."""

    def full(self) -> np.ndarray:
        """Number of particles in a full cell of its body at the start."""

    def with_room(self, which: np.ndarray, axis: int) -> np.ndarray:
        """Of the particles ``which`` (True or False), those whose halves find room; True or False.

        One half comes into the next cell along the axis, or both stay in their own. There is room as long as
        that cell has fewer particles of the material than a full one at the start; longest boxes come first.
        """

    def nearest_pairs(self, largest: float) -> np.ndarray:
        """Pairs of particles to merge, ``(m, 2)`` indices, the nearest pair first; ``(0, 2)`` without a pair.

        In each cell with more particles of a material than a full cell at the start, as many pairs as there
        are too many. The two are of the same fluid and body, each is the nearest to the other, and their
        portions add up to ``largest`` at most.
        """

    def split(self, which: np.ndarray, axis: int) -> None:
        """Halve the boxes of particles ``which`` (True or False) along an axis; each half is a particle."""

    def cut(self, which: np.ndarray, axis: int) -> None:
        """Shorten the boxes of particles ``which`` (True or False) along an axis to the side of a cell."""

    def merge(self, pairs: np.ndarray) -> None:
        """Make one particle of each pair, ``(m, 2)`` numbers of rows, each row at most once.

        The two must be of the same body, and of a fluid.
        """


class Refinement(Plugin):
    """How the number of particles follows the flow.

    The framework carries out the choice and conserves mass, volume, momentum and centre of mass.
    """

    def refine(self, ops: Refining) -> None:
        """Split, cut and merge particles; called every few steps; default: nothing."""
        return
