"""Nodes with quadratic B-splines over the material: crowding, averages, slopes."""

from __future__ import annotations

import numpy as np

from ...contracts import redistribution as contract
from ...errors import PluginFault
from ...kernels.gather import gather_scalar
from ...kernels.scatter import PAIR, scatter_pairs
from ...kernels.splines import SUPPORT, fill_splines, gather_slope
from .mirrored import Mirrored, require_field


class SplineLattice:
    """Implements the contract ``Lattice``; the splines use the positions at the time of its creation.

    Args:
        block: its nodes.
        tasks: of the sorted particles, for sums in parallel.
        position: ``(n, dim)``, m.
        size: ``(n,)``, area or volume of each particle.
    """

    def __init__(self, block: Mirrored, tasks: np.ndarray, position: np.ndarray, size: np.ndarray) -> None:
        n, dim = position.shape
        self.block = block
        self.spacing = block.spacing
        self._tasks, self._size = tasks, size
        self._base = np.empty((n, dim), dtype=np.int32)
        self._weight = np.empty((n, dim, SUPPORT))
        fill_splines(position, 1 / block.spacing, self._base, self._weight)

    def crowding(self) -> np.ndarray:
        crowding = self.block.crowded(self._sums(self._size, self._size)[:, 0])
        self.block.fill(crowding)
        return crowding

    def average(self, values: np.ndarray, weight: np.ndarray | None = None) -> np.ndarray:
        require_field(values, len(self._base), "particles")
        values = np.ascontiguousarray(values, dtype=np.float64)
        sums = self._sums(values, self._size if weight is None else weight)
        average = np.divide(sums[:, 1], sums[:, 0], out=np.zeros(len(sums)), where=sums[:, 0] > 0)
        self.block.fill(average)
        return average

    def at_particles(self, nodal: np.ndarray) -> np.ndarray:
        block, out = self.block, np.empty(len(self._base))
        gather_scalar(self._dim, SUPPORT)(
            block.field(nodal), block.strides, block.lower, self._base, self._weight, out
        )
        return out

    def slope_at_particles(self, nodal: np.ndarray) -> np.ndarray:
        block, slope = self.block, np.empty(self._base.shape)
        field = block.field(nodal)[:, 0]
        gather_slope(self._dim)(
            field, block.strides, block.lower, self._base, self._weight, 1 / block.spacing, slope
        )
        return slope

    def least_around(self, nodal: np.ndarray) -> np.ndarray:
        require_field(nodal, self.block.count, "nodes")
        return self.block.least_around(nodal)

    def nearest(self, other: contract.Lattice, nodal: np.ndarray) -> np.ndarray:
        if not isinstance(other, SplineLattice):
            raise PluginFault(None, "asked for the nearest nodes of what is no lattice of this scene")
        require_field(nodal, other.block.count, "nodes")
        found = nodal.reshape(other.block.shape)
        times = round(other.spacing / self.spacing)
        for axis, (count, low, their_low) in enumerate(
            zip(self.block.shape, self.block.lower, other.block.lower, strict=True)
        ):
            number = np.floor((np.arange(count) + low) / times + 0.5).astype(np.int64) - their_low
            found = np.take(found, np.clip(number, 0, other.block.shape[axis] - 1), axis=axis)
        return found.ravel()

    @property
    def _dim(self) -> int:
        return self._base.shape[1]

    def _sums(self, values: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Σ w N and Σ w N f of every node, ``(nodes, 2)``, with the sums on ghosts folded in."""
        block, pairs = self.block, self.block.empty(PAIR)
        scatter_pairs(self._dim, SUPPORT)(
            pairs, block.strides, block.lower, self._tasks, self._base, self._weight, weight, values
        )
        block.fold(pairs)
        return pairs
