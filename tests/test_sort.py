"""The order of the particles: a stable sort by block and cell; blocks of one colour share no node."""

from __future__ import annotations

from itertools import pairwise

import numba
import numpy as np
import pytest
from blocks import Blocks

import mpmkit
from mpmkit.kernels import sort
from mpmkit.kernels.compile import CHUNK
from mpmkit.kernels.scatter import LARGEST_SUPPORT, PAIR, scatter_pairs, scatter_scalar
from mpmkit.kernels.sort import BLOCK_WIDTH
from mpmkit.registry import installed
from mpmkit.solver.sorting import DRIFT, TASKS

SHAPES = installed().of_kind("shape")
sizes = pytest.mark.parametrize("size", [(1, 1), (4, 3), (5, 2), (1, 1, 1), (3, 4, 5), (1, 7, 1)], ids=str)


@pytest.fixture(autouse=True)
def _two_threads():
    numba.set_num_threads(2)


def numbered(size):
    """Number of each block by place, its lowest cell by number, the first of each colour."""
    count = int(np.prod(size))
    index, cell = np.empty(count, dtype=np.int64), np.empty((count, len(size)), dtype=np.int64)
    of_colour = sort.number_blocks(np.array(size), index, cell)
    return index, cell, of_colour


@sizes
def test_blocks_are_numbered_colour_by_colour(size):
    index, cell, of_colour = numbered(size)
    count, dim = len(index), len(size)
    assert (np.sort(index) == np.arange(count)).all()
    place = np.stack(np.unravel_index(np.arange(count), size), axis=1)
    np.testing.assert_array_equal(cell[index], place * BLOCK_WIDTH)
    assert (of_colour[0], of_colour[-1], len(of_colour)) == (0, count, 2**dim + 1)
    colour = np.repeat(np.arange(2**dim), np.diff(of_colour))
    parity = cell // BLOCK_WIDTH % 2
    assert len(np.unique(np.column_stack([colour, parity]), axis=0)) == len(np.unique(parity, axis=0))
    assert len(np.unique(colour)) == len(np.unique(parity, axis=0))


@pytest.mark.parametrize("dim", [2, 3])
def test_cells(dim):
    position = np.random.default_rng(1).uniform(0, 9, (2 * CHUNK + 3, dim))
    cell = np.empty(position.shape, dtype=np.int32)
    sort.find_cells(position, 4.0, cell)
    np.testing.assert_array_equal(cell, np.floor(4 * position))


@sizes
def test_a_key_is_the_block_and_the_cell_in_it(size):
    rng, dim = np.random.default_rng(2), len(size)
    low = np.array([-4, 17, 3][:dim])
    index, lowest, _ = numbered(size)
    cell = (low + rng.integers(0, np.array(size) * BLOCK_WIDTH, (CHUNK + 9, dim))).astype(np.int32)
    key = np.empty(len(cell), dtype=np.int64)
    sort.find_keys(cell, low, np.array(size), index, key)
    block, within = np.divmod(key, BLOCK_WIDTH**dim)
    within = np.stack(np.unravel_index(within, (BLOCK_WIDTH,) * dim), axis=1)
    np.testing.assert_array_equal(low + lowest[block] + within, cell)


@pytest.mark.parametrize(("begin", "end"), [(0, 500), (120, 431), (200, 200), (7, 8)])
def test_counting_sort_is_a_stable_permutation_of_its_part(begin, end):
    key = np.random.default_rng(3).choice([0, 1, 4, 5, 30, 39], 500)
    order, first = np.full(500, -1), np.full(41, -7)
    sort.counting_sort(key, begin, end, first, order)
    expected = begin + np.argsort(key[begin:end], kind="stable")
    np.testing.assert_array_equal(order[begin:end], expected)
    assert (np.delete(order, np.s_[begin:end]) == -1).all()
    np.testing.assert_array_equal(first, begin + np.searchsorted(key[expected], np.arange(41)))


@pytest.mark.parametrize("dtype", [np.int32, np.int64, np.float64])
@pytest.mark.parametrize("width", [1, 9])
def test_permute(dtype, width):
    rng = np.random.default_rng(4)
    rows = (rng.normal(size=(2 * CHUNK + 5, width)) * 100).astype(dtype)
    order, out = rng.permutation(len(rows)), np.empty_like(rows)
    sort.permute(rows, order, out)
    np.testing.assert_array_equal(out, rows[order])


@pytest.mark.parametrize("dim", [2, 3])
def test_particles_are_sorted_by_group_colour_block_and_cell(dim):
    rng = np.random.default_rng(5)
    cell = rng.integers(-3, [25, 17, 14][:dim], (3000, dim)).astype(np.int32)
    group = np.sort(rng.integers(0, 3, 3000))
    blocks = Blocks.of(cell, group)
    assert (np.sort(blocks.order) == np.arange(3000)).all()
    assert (group[blocks.order] == group).all()
    found = cell[blocks.order]
    within = found - blocks.cell[blocks.number]
    assert ((within >= 0) & (within < BLOCK_WIDTH)).all()
    expected = np.lexsort((blocks.order, *within.T[::-1], blocks.number, group))
    np.testing.assert_array_equal(expected, np.arange(3000))
    for g in range(3):
        ends = np.searchsorted(blocks.number[group == g], np.arange(len(blocks.cell) + 1))
        np.testing.assert_array_equal(blocks.first[g], np.searchsorted(group, g) + ends)


# --- Races --------------------------------------------------------------------------------------------------


def reach(shape):
    """First and last node, from its lowest cell, that particles of a block may touch along an axis.

    Particles of any size, all over each cell and at its very edges.
    """
    cells = np.arange(-DRIFT, BLOCK_WIDTH + DRIFT) + 10.0
    x = np.concatenate([cells, np.nextafter(cells + 1, 0), *(cells + part for part in (0.2, 0.4, 0.6, 0.8))])
    first, last = [], []
    for half_size in (1e-6, 0.25, 0.5, 3.0):
        base, tables = np.empty((len(x), 1), dtype=np.int32), np.empty((2, len(x), 1, shape.support))
        shape.fill(x[:, None], np.full((len(x), 1), half_size), 1.0, base, *tables)
        first.append(base.min() - 10)
        last.append(base.max() + shape.support - 1 - 10)
    return min(first), max(last)


@pytest.mark.parametrize("pairs", [False, True], ids=["records", "pairs"])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("size", [(5, 4), (3, 5), (4, 3, 5)], ids=str)
def test_blocks_of_one_colour_touch_no_common_node(size, shape, pairs):
    """Whatever their particles do before the next sort, and with the nodes that rows of pairs write along."""
    shape = SHAPES[shape]()
    first, last = reach(shape)
    ends = [last] * len(size)
    if pairs:
        ends[-1] += LARGEST_SUPPORT - shape.support
    _, lowest, of_colour = numbered(size)
    for begin, end in pairwise(of_colour):
        touched = np.zeros([BLOCK_WIDTH * n + 10 for n in size], dtype=int)
        for block in lowest[begin:end]:
            touched[tuple(slice(b + 4 + first, b + 4 + e + 1) for b, e in zip(block, ends, strict=True))] += 1
        assert touched.max(initial=0) <= 1
        assert touched.sum() == (end - begin) * np.prod([e + 1 - first for e in ends])  # none cut off


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("support", range(2, LARGEST_SUPPORT + 1))
def test_rows_of_pairs_write_to_no_node_further_on(support, dim):
    """-0.0 turns into 0.0 even where nothing is added: a particle's own nodes, and those behind its rows."""
    size = 9
    base = np.full((1, dim), 3, dtype=np.int32)
    weight, one = np.ones((1, dim, support)), np.ones(1)
    pairs, strides = np.full((size**dim, PAIR), -0.0), (size ** (dim - 1), size ** (dim - 2), 1)
    tasks = np.array([[[0, 1]]])
    scatter_pairs(dim, support)(pairs, strides, np.zeros(dim, dtype=np.int64), tasks, base, weight, one, one)
    expected = np.zeros((size,) * dim, dtype=bool)
    rows, nodes = slice(3, 3 + support), slice(3, 3 + LARGEST_SUPPORT)
    expected[(*[rows] * (dim - 1), nodes)] = True
    np.testing.assert_array_equal(~np.signbit(pairs), np.repeat(expected.reshape(-1, 1), PAIR, axis=1))


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("support", range(2, LARGEST_SUPPORT + 1))
def test_rows_of_numbers_write_to_no_node_further_on(support, dim):
    """As rows of pairs."""
    size = 9
    base = np.full((1, dim), 3, dtype=np.int32)
    weight, one, sums = np.ones((1, dim, support)), np.ones(1), np.full(size**dim, -0.0)
    strides, tasks = (size ** (dim - 1), size ** (dim - 2), 1), np.array([[[0, 1]]])
    scatter_scalar(dim, support)(sums, strides, np.zeros(dim, dtype=np.int64), tasks, base, weight, one)
    expected = np.zeros((size,) * dim, dtype=bool)
    expected[(*[slice(3, 3 + support)] * (dim - 1), slice(3, 3 + LARGEST_SUPPORT))] = True
    np.testing.assert_array_equal(~np.signbit(sums), expected.ravel())


# --- Tasks --------------------------------------------------------------------------------------------------


def box(lower, upper, law, **material):
    shape = {"kind": "box", "lower": lower, "upper": upper}
    return {"shape": shape, "material": {"law": law, "density": 1000.0, **material}}


@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_tasks_cut_the_blocks_of_every_colour_once(space):
    """Tasks share no block, not even through the other material; together they are all particles."""
    kept = slice(None) if space == "3d" else slice(0, 3, 2)
    fluid = box([0.3, 0.2, 0.1][kept], [2.9, 1.0, 1.5][kept], "newtonian", viscosity=1.0, sound_speed=10.0)
    rubber = {"youngs_modulus": 1e5, "poisson_ratio": 0.3}
    solid = box([0.3, 0.2, 1.5][kept], [2.0, 0.9, 2.1][kept], "neo-hookean", **rubber)
    case = {
        "space": space,
        "until": 1.0,
        "gravity": [0.0, 0.0, 0.0][kept],
        "grid": {"cell_size": 0.1, "domain": {axis: [0, 4] for axis in "xyz"[kept]}},
        "bodies": [fluid, solid],
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    simulation.operations.begin()
    particles, tasks = simulation.particles, simulation.operations.sorting.tasks
    dim = particles.dim
    assert tasks.shape == (2, 2**dim, TASKS + 1)
    cell = (particles.position / 0.1).astype(int)
    place = (cell - cell.min(axis=0)) // BLOCK_WIDTH
    block = np.ravel_multi_index(place.T, place.max(axis=0) + 1)
    owner = np.full((len(particles), 2), -1)
    for g, group in enumerate(particles.groups):
        assert (tasks[g, 0, 0], tasks[g, -1, -1]) == (group.part.start, group.part.stop)
        assert (tasks[g, 1:, 0] == tasks[g, :-1, -1]).all()
        assert (np.diff(tasks[g]) >= 0).all()
        for colour, task in np.ndindex(2**dim, TASKS):
            owner[tasks[g, colour, task] : tasks[g, colour, task + 1]] = colour, task
    of_block = np.unique(np.column_stack([block, owner]), axis=0)
    assert len(of_block) == len(np.unique(block))  # each block has one owner
    parity = np.unique(np.column_stack([place % 2, owner[:, :1]]), axis=0)
    assert len(parity) == len(np.unique(place % 2, axis=0)) == len(np.unique(owner[:, 0]))
    load = np.diff(tasks).sum(axis=0)
    largest = np.bincount(block).max()
    assert (load <= load.sum(axis=1, keepdims=True) / TASKS + largest).all()  # of about equal load
    assert ((load > 0).sum(axis=1) > 1).any()  # some are there to run in parallel
