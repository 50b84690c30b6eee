"""The order of the particles in memory: colour by colour, block by block, cell by cell.

A block is ``BLOCK_WIDTH`` cells wide along every axis. Its colour is the parity of its number along each
axis, so that two blocks of one colour are never neighbours. The nodes of a block fit into the L1 cache of a
core.
"""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, function, kernel

BLOCK_WIDTH = 6
"""Width in cells. A particle that has drifted a cell out of its block touches nodes from 2 below the block's
cells to 3 above them, and a row of pairs reaches one node further. With 6 cells, blocks of one colour never
touch the same node."""


@kernel()
def find_cells(position, inverse_cell, cell):
    """Cells of all particles, ``(n, dim)``."""
    n, dim = position.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            for d in range(dim):
                cell[p, d] = int(position[p, d] * inverse_cell)


@function()
def number_blocks(blocks, block_index, block_cell):
    """Number all blocks, colour by colour. ``block_index`` becomes the number of the block at each place, and
    ``block_cell`` the lowest cell of the block with each number.

    Returns the first block of each colour, and, as the last entry, the number of blocks.
    """
    dim = len(blocks)
    colours = 1 << dim
    first = np.zeros(colours + 1, dtype=np.int64)
    total = 1
    for d in range(dim):
        total *= blocks[d]
    number = 0
    for colour in range(colours):
        first[colour] = number
        for place in range(total):
            rest, parity = place, 0
            for d in range(dim - 1, -1, -1):
                parity |= (rest % blocks[d] & 1) << d
                rest //= blocks[d]
            if parity != colour:
                continue
            rest = place
            for d in range(dim - 1, -1, -1):
                block_cell[number, d] = rest % blocks[d] * BLOCK_WIDTH
                rest //= blocks[d]
            block_index[place] = number
            number += 1
    first[colours] = number
    return first


@kernel()
def find_keys(cell, low, blocks, block_index, key):
    """Sort keys of the particles: number of the block and of the cell within it, as one integer."""
    n, dim = cell.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            place = within = 0
            cells = 1
            for d in range(dim):
                k = cell[p, d] - low[d]
                place = place * blocks[d] + k // BLOCK_WIDTH
                within = within * BLOCK_WIDTH + k % BLOCK_WIDTH
                cells *= BLOCK_WIDTH
            key[p] = block_index[place] * cells + within


@function()
def counting_sort(key, begin, end, count, order):
    """Stable order of particles begin..end-1 by their keys, into ``order``.

    ``count`` has one entry more than there are keys, and becomes the first particle of each key.
    """
    count[:] = 0
    for p in range(begin, end):
        count[key[p] + 1] += 1
    count[0] = begin
    for k in range(1, len(count)):
        count[k] += count[k - 1]
    for p in range(begin, end):
        k = key[p]
        order[count[k]] = p
        count[k] += 1
    for k in range(len(count) - 1, 0, -1):
        count[k] = count[k - 1]
    count[0] = begin


@kernel()
def permute(rows, order, out):
    """out[p] = rows[order[p]], for arrays ``(n, width)``."""
    n, width = rows.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            for k in range(width):
                out[p, k] = rows[order[p], k]
