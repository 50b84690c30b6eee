"""The order of the particles in memory: colour by colour, block by block, cell by cell.

A block is ``BLOCK_WIDTH`` cells wide along every axis; its colour is the parity of its place along each, so
that two blocks of one colour are never neighbours. A block's nodes fit into the cache nearest to a core.
"""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, function, kernel

BLOCK_WIDTH = 6
"""Cells. A particle that has drifted a cell out of its block touches nodes from 2 below to 2 above the
block's cells and one more, and a row of pairs reaches a node beyond that; with 6 cells blocks of one colour
never meet."""


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
    """Number all blocks, colour by colour: ``block_index`` by place, ``block_cell`` the lowest cell by
    number.

    Returns the first block of each colour, and their number last.
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
    """Where a particle belongs: the number of its block and its cell within it, as one integer."""
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

    ``count`` becomes the first of each key, with one entry more than there are keys.
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
    """out[p] = rows[order[p]], of arrays ``(n, width)``."""
    n, width = rows.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            for k in range(width):
                out[p, k] = rows[order[p], k]
