"""Checks where particles are: in the domain, and near the block and window into which they were sorted."""

from __future__ import annotations

from functools import cache

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, inline, kernel
from .sort import BLOCK_WIDTH

HERE, STRAYED, LOST = range(3)
"""All particles in place; one has drifted too far from its block or window; one is outside or not finite."""

SHARES = 64
"""Number of shares among which the blocks are distributed in turn."""


@cache
def locate(dim: int):
    """The kernel that checks all particles and their domains.

    ``locate(position, half_size, extent, inverse_cell, block_first, block_cell, window_low, window_high,
    verdicts)`` returns the worst verdict and the particle that is ``LOST``.

    A particle may drift anywhere between the cells ``window_low`` and ``window_high``, but no more than one
    cell beyond its block. ``block_first[g, b]`` is the first particle of block b in group g, and
    ``block_cell`` its lowest cell; ``verdicts`` is scratch, two integers for each block.
    """

    @inline()
    def all_here(position, half_size, begin, end, extent, inverse_cell, block_cell, window_low, window_high):
        """Whether all particles of a block are in place, as they nearly always are.

        The arrays are flat, so that the compiler can treat several particles at once.
        """
        good = True
        for d in range(dim):
            least = float(max(window_low[d], block_cell[d] - 1))
            most = float(min(window_high[d], block_cell[d] + BLOCK_WIDTH) + 1)
            x, half, longest = (
                position[dim * begin : dim * end],
                half_size[dim * begin : dim * end],
                extent[d],
            )
            for k in range(end - begin):
                good &= (x[dim * k + d] >= 0.0) & (x[dim * k + d] <= longest)
                good &= (half[dim * k + d] > 0.0) & (half[dim * k + d] < np.inf)
                good &= (x[dim * k + d] * inverse_cell >= least) & (x[dim * k + d] * inverse_cell < most)
        return good

    @kernel()
    def locate(
        position, half_size, extent, inverse_cell, block_first, block_cell, window_low, window_high, verdicts
    ):
        blocks, positions, half_sizes = len(block_cell), position.reshape(-1), half_size.reshape(-1)
        for share in prange(SHARES):  # each share has blocks of every colour: neighbours differ in load
            for b in range(share, blocks, SHARES):
                worst, who = HERE, -1
                for g in range(block_first.shape[0]):
                    if all_here(
                        positions, half_sizes, block_first[g, b], block_first[g, b + 1], extent, inverse_cell,
                        block_cell[b], window_low, window_high,
                    ):  # fmt: skip
                        continue
                    for p in range(block_first[g, b], block_first[g, b + 1]):
                        here = there = True
                        for d in range(dim):
                            x, half = position[p, d], half_size[p, d]
                            # Also false for NaN. A box without a size would give wrong weights.
                            there &= (x >= 0.0) & (x <= extent[d]) & (half > 0.0) & (half < np.inf)
                            cells = x * inverse_cell
                            here &= cells >= max(window_low[d], block_cell[b, d] - 1)
                            here &= cells < min(window_high[d], block_cell[b, d] + BLOCK_WIDTH) + 1
                        if not there and worst != LOST:
                            worst, who = LOST, p
                        elif not here and worst == HERE:
                            worst = STRAYED
                verdicts[b, 0], verdicts[b, 1] = worst, who
        worst, who = HERE, -1
        for b in range(blocks):
            if verdicts[b, 0] > worst:
                worst, who = verdicts[b, 0], verdicts[b, 1]
        return worst, who

    return locate


@kernel()
def wrap(position, axis, length):
    """Bring particles that left a periodic axis back in at the other end."""
    n = len(position)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            x = position[p, axis]
            if x < 0.0 or x >= length:
                position[p, axis] = x - np.floor(x / length) * length


@kernel()
def put_back(position, axis, low, high, most):
    """Put particles that are behind a wall at ``low`` or ``high``, by no more than ``most``, back onto it.

    A wall acts on nodes, but a particle at the wall also moves with the nodes beside it. A particle that went
    further was thrown out by a fault. It stays there, so that the guards see it.
    """
    n = len(position)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            x = position[p, axis]
            if low - most <= x < low:
                position[p, axis] = low
            elif high < x <= high + most:
                position[p, axis] = high


@kernel()
def first_unsound(position, velocity, stress, pressure, volume_ratio, least, most, firsts):
    """First particle whose state is not finite or whose volume ratio is not in [least, most]; -1 without one.

    ``firsts`` is scratch, an integer for each chunk.
    """
    n, dim = position.shape
    chunks = chunk_count(n)
    for c in prange(chunks):
        first = -1
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            # The sum of finite numbers may overflow, but a sound run has no numbers that large.
            total = pressure[p]
            for d in range(dim):
                total += position[p, d] + velocity[p, d]
            for k in range(6):
                total += stress[p, k]
            if not (np.isfinite(total) and least <= volume_ratio[p] <= most) and first < 0:
                first = p
        firsts[c] = first
    for c in range(chunks):
        if firsts[c] >= 0:
            return firsts[c]
    return -1


@kernel()
def first_not_finite(rows, firsts):
    """First of ``rows (n, width)`` with an entry that is not finite; -1 if there is none.

    ``firsts`` is scratch, an integer for each chunk.
    """
    n, width = rows.shape
    chunks = chunk_count(n)
    for c in prange(chunks):
        first, begin, end = -1, c * CHUNK, min(n, (c + 1) * CHUNK)
        total = 0.0
        for p in range(begin, end):
            row = 0.0  # a sum for each row, so that rows need not wait for each other
            for k in range(width):
                row += 0.0 * rows[p, k]  # 0 × ∞ is not a number, and nothing overflows
            total += row
        if total != 0.0:
            for p in range(end - 1, begin - 1, -1):
                for k in range(width):
                    if not np.isfinite(rows[p, k]):
                        first = p
        firsts[c] = first
    for c in range(chunks):
        if firsts[c] >= 0:
            return firsts[c]
    return -1
