"""The cells of the grid over the material, and the part of each particle's box in them."""

from __future__ import annotations

import numpy as np

from ...kernels.gather import gather_scalar
from ...kernels.scatter import scatter_scalar
from ...kernels.splines import PARTS, fill_parts
from .mirrored import Mirrored, require_field


class BoxCells:
    """Implements the contract ``Cells``; the part of a box behind a wall counts to the cell in front of it.

    Args:
        block: the cells.
        tasks: of the sorted particles, for sums in parallel.
        position, half_size: ``(n, dim)``, m, of the boxes.
        size: ``(n,)``, area or volume of each particle.
    """

    def __init__(
        self,
        block: Mirrored,
        tasks: np.ndarray,
        position: np.ndarray,
        half_size: np.ndarray,
        size: np.ndarray,
    ) -> None:
        n, self._dim = position.shape
        self.block = block
        self._tasks, self._size = tasks, size
        self._base = np.empty((n, self._dim), dtype=np.int32)
        self._part = np.empty((n, self._dim, PARTS))
        fill_parts(position, half_size, 1 / block.spacing, self._base, self._part)

    def filling(self, weights: np.ndarray | None = None) -> np.ndarray:
        block, sums = self.block, self.block.empty()[:, 0]
        size = self._size if weights is None else self._size * weights
        scatter_scalar(self._dim, PARTS)(
            sums, block.strides, block.lower, self._tasks, self._base, self._part, size
        )
        block.fold(sums)
        filling = block.crowded(sums)
        block.fill(filling)
        return filling

    def least_beside(self, filling: np.ndarray) -> np.ndarray:
        require_field(filling, self.block.count, "cells")
        return self.block.least_beside(filling)

    def at_particles(self, values: np.ndarray) -> np.ndarray:
        block, field, out = self.block, self.block.field(values), np.empty(len(self._base))
        gather_scalar(self._dim, PARTS)(field, block.strides, block.lower, self._base, self._part, out)
        return out
