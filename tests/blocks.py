"""Particles in the order of ``mpmkit.kernels.sort``, for tests of the kernels that use it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mpmkit.kernels import sort


@dataclass
class Blocks:
    """Particles in given cells after a sort."""

    order: np.ndarray
    """(n,) the particles, group by group, colour by colour, block by block, cell by cell"""
    first: np.ndarray
    """(groups, blocks + 1) first particle of each block, in that order"""
    cell: np.ndarray
    """(blocks, dim) lowest cell of each block"""
    of_colour: np.ndarray
    """(colours + 1,) first block of each colour"""
    number: np.ndarray
    """(n,) block of each particle, in that order"""

    @classmethod
    def of(cls, cell: np.ndarray, group: np.ndarray) -> Blocks:
        """Sort particles whose groups already are in ascending order."""
        (n, dim), low = cell.shape, cell.min(axis=0).astype(np.int64)
        size = (cell.max(axis=0) - low) // sort.BLOCK_WIDTH + 1
        count, cells = int(np.prod(size)), sort.BLOCK_WIDTH**dim
        index, lowest = np.empty(count, dtype=np.int64), np.empty((count, dim), dtype=np.int64)
        of_colour = sort.number_blocks(size, index, lowest)
        key, order = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
        sort.find_keys(cell, low, size, index, key)
        groups = int(group[-1]) + 1
        first = np.empty((groups, count + 1), dtype=np.int64)
        of_key = np.empty(count * cells + 1, dtype=np.int64)
        for g in range(groups):
            begin, end = np.searchsorted(group, [g, g + 1])
            sort.counting_sort(key, begin, end, of_key, order)
            first[g] = of_key[::cells]
        return cls(order, first, lowest + low, of_colour, key[order] // cells)

    def tasks(self, pieces: int = 3) -> np.ndarray:
        """(groups, colours, pieces + 1) first particles of the tasks, about as many blocks in each."""
        cuts = [np.linspace(*ends, pieces + 1).astype(int) for ends in pairwise(self.of_colour)]
        return np.ascontiguousarray(self.first[:, np.array(cuts)])
