"""Nodes with quadratic B-splines over the material: crowding, averages, slopes."""

from __future__ import annotations

import numpy as np

from ...contracts import redistribution as contract
from ...errors import PluginFault
from ...kernels.gather import gather_scalar
from ...kernels.scatter import scatter_scalar
from ...kernels.splines import SUPPORT, fill_splines, gather_slope
from .mirrored import Mirrored, require_field


class SplineLattice:
    """Implements the contract ``Lattice``; the splines use the positions at the time of its creation.

    Args:
        block: its nodes.
        tasks: of the sorted particles, for sums in parallel.
        position: ``(n, dim)``, m.
        size: ``(n,)``, area or volume of each particle.
        base, weight: ``(n, dim)`` integers and ``(n, dim, 3)``, memory for the splines.
    """

    def __init__(
        self,
        block: Mirrored,
        tasks: np.ndarray,
        position: np.ndarray,
        size: np.ndarray,
        base: np.ndarray,
        weight: np.ndarray,
    ) -> None:
        self.block = block
        self.spacing = block.spacing
        self._tasks, self._size = tasks, size
        self._base, self._weight = base, weight
        self._sums_of_size: np.ndarray | None = None
        fill_splines(position, 1 / block.spacing, self._base, self._weight)

    def crowding(self) -> np.ndarray:
        crowding = self.block.crowded(self._of_size())
        self.block.fill(crowding)
        return crowding

    def average(self, values: np.ndarray) -> np.ndarray:
        require_field(values, len(self._base), "particles")
        return self._over(self._sums(self._size * values), self._of_size())

    def averages(self, vectors: np.ndarray, weight: np.ndarray) -> list[np.ndarray]:
        """Σ w N f / Σ w N of each component of vectors, ``(n, k)``, with the weights w, ``(n,)``."""
        total = self._sums(weight)
        return [self._over(self._sums(weight * along), total) for along in vectors.T]

    def at_particles(self, nodal: np.ndarray) -> np.ndarray:
        block, out = self.block, np.empty(len(self._base))
        gather_scalar(self._dim, SUPPORT)(
            block.field(nodal), block.strides, block.lower, self._base, self._weight, out
        )
        return out

    def slope_at_particles(self, nodal: np.ndarray) -> np.ndarray:
        block, slope = self.block, np.empty(self._base.shape)
        gather_slope(self._dim)(
            block.field(nodal), block.strides, block.lower, self._base, self._weight, 1 / block.spacing, slope
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

    def _sums(self, amount: np.ndarray) -> np.ndarray:
        """Σ N amount of every node, ``(nodes,)``, with the sums on ghosts folded in."""
        block = self.block
        sums = block.empty()[:, 0]
        scatter_scalar(self._dim, SUPPORT)(
            sums, block.strides, block.lower, self._tasks, self._base, self._weight, amount
        )
        block.fold(sums)
        return sums

    def _of_size(self) -> np.ndarray:
        """Σ size N of every node."""
        if self._sums_of_size is None:
            self._sums_of_size = self._sums(self._size)
        return self._sums_of_size

    def _over(self, sums: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Sums over weights at the nodes, zero where nothing is, with the ghosts filled."""
        average = np.divide(sums, weights, out=sums, where=weights > 0)
        self.block.fill(average)
        return average
