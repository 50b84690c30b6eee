"""Where particles are: in place, strayed or lost, on each axis and for every reason."""

from __future__ import annotations

import numpy as np
import pytest
from blocks import Blocks
from pairwise import every_pair

from mpmkit.kernels import locate
from mpmkit.kernels.compile import CHUNK, chunk_count
from mpmkit.kernels.sort import BLOCK_WIDTH

pytestmark = pytest.mark.usefixtures("each_number_of_threads")


class Sorted:
    """Particles in two groups and 4 × 2 blocks from cell (10, 5), in a domain of 50 × 20 cells."""

    cell = 0.1

    def __init__(self, n=4 * CHUNK, seed=15):
        rng = np.random.default_rng(seed)
        self.extent = np.array([5.0, 2.0])
        low, size = np.array([10, 5]), np.array([4, 2]) * BLOCK_WIDTH
        cell = (low + rng.integers(0, size, (n, 2))).astype(np.int32)
        cell[0], cell[-1] = low, low + size - 1
        group = np.sort(rng.integers(0, 2, n))
        kept = (group == 0) | ((cell - low) // BLOCK_WIDTH != [2, 0]).any(axis=1)  # an empty block of a group
        cell, group = cell[kept], group[kept]
        self.blocks = Blocks.of(cell, group)
        assert (np.diff(self.blocks.first) == 0).any()
        self.block = self.blocks.cell[self.blocks.number]
        """Lowest cell of each particle's block."""
        self.position = self.cell * (cell[self.blocks.order] + rng.uniform(0.01, 0.99, cell.shape))
        self.half_size = np.full(cell.shape, 0.25 * self.cell)
        self.low, self.high = low - 1, low + size
        self.verdicts = np.empty((len(self.blocks.cell), 2), dtype=np.int64)

    def ask(self):
        return locate.locate(2)(
            self.position, self.half_size, self.extent, 1 / self.cell, self.blocks.first, self.blocks.cell,
            self.low, self.high, self.verdicts,
        )  # fmt: skip


def test_particles_in_place_are_here():
    assert Sorted().ask() == (locate.HERE, -1)


@pytest.mark.parametrize("size", [0.0, -0.01, np.nan, np.inf])
def test_a_particle_without_a_box_is_noticed(size):
    particles = Sorted()
    particles.half_size[300, 1] = size
    assert particles.ask() == (locate.LOST, 300)


@every_pair(
    "p, axis, place",
    [0, 300, 777, -1],
    [0, 1],
    [
        (lambda block: block - 0.5, locate.HERE),  # within a cell below its block
        (lambda block: block - 1.5, locate.STRAYED),
        (lambda block: block + BLOCK_WIDTH + 0.5, locate.HERE),
        (lambda block: block + BLOCK_WIDTH + 1.5, locate.STRAYED),
        (lambda block: -0.01, locate.LOST),
        (lambda block: 50.01, locate.LOST),
        (lambda block: np.nan, locate.LOST),
        (lambda block: np.inf, locate.LOST),
        (lambda block: -np.inf, locate.LOST),
    ],
)
def test_a_particle_elsewhere_is_noticed(p, axis, place):
    particles, (where, verdict) = Sorted(), place
    p %= len(particles.position)
    particles.position[p, axis] = where(particles.block[p, axis]) * particles.cell
    found, who = particles.ask()
    assert found == verdict
    assert who == (p if verdict == locate.LOST else -1)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("upper", [False, True], ids=["low", "high"])
def test_a_particle_outside_the_window_has_strayed_whatever_its_block(axis, upper):
    """The window is laid around the cells that were occupied; a block may reach far beyond it."""
    particles = Sorted()
    edge = particles.block[:, axis].max() + 2 if upper else particles.block[:, axis].min() + 3
    (particles.high if upper else particles.low)[axis] = edge
    cells = particles.position[:, axis] / particles.cell
    np.clip(cells, *((0, edge + 0.5) if upper else (edge + 0.5, 99)), out=cells)
    particles.position[:, axis] = cells * particles.cell
    assert particles.ask()[0] == locate.HERE
    p = int(np.flatnonzero(cells == edge + 0.5)[7])
    particles.position[p, axis] = (edge + (1.5 if upper else -0.5)) * particles.cell
    assert particles.ask() == (locate.STRAYED, -1)


def test_a_lost_particle_matters_more_than_those_that_have_strayed():
    for strays, lost in ([0, -1], 300), ([300], 0), ([300], -1), ([299], 300), ([301], 300):
        particles = Sorted()
        particles.position[strays, 0] = 0.05
        particles.position[lost, 1] = np.nan
        assert particles.ask() == (locate.LOST, lost % len(particles.position))


def test_wrap():
    rng = np.random.default_rng(16)
    position = rng.uniform(-3, 5, (CHUNK + 9, 3))
    position[:3, 1] = [0.0, 2.0, -1e-18]
    expected = position.copy()
    expected[:, 1] = position[:, 1] - np.floor(position[:, 1] / 2.0) * 2.0
    locate.wrap(position, 1, 2.0)
    np.testing.assert_allclose(position, expected, rtol=0, atol=1e-15)
    assert (position[:, 1] >= 0).all()
    assert (position[:, 1] <= 2.0).all()


@pytest.mark.parametrize(("n", "chunks"), [(0, 0), (1, 1), (CHUNK, 1), (CHUNK + 1, 2)])
def test_chunks(n, chunks):
    assert chunk_count(n) == chunks


def sound_state(n, dim=2):
    rng = np.random.default_rng(18)
    state = [rng.normal(size=shape) for shape in ((n, dim), (n, dim), (n, 6), (n,))]
    return [*state, rng.uniform(0.5, 2.0, n)]


@every_pair(
    "bad, field, value",
    [[], [0], [CHUNK], [3 * CHUNK], [5, 2 * CHUNK + 7]],
    range(5),
    [np.nan, np.inf, -np.inf],
)
def test_the_first_unsound_particle(bad, field, value):
    state = sound_state(3 * CHUNK + 1)
    rows = state[field].reshape(len(state[field]), -1)
    rows[bad, -1] = value
    firsts = np.empty(len(rows) // CHUNK + 1, dtype=np.int64)
    with np.errstate(invalid="ignore"):  # NumPy's, where kernels are not compiled
        assert locate.first_unsound(*state, 0.1, 10.0, firsts) == (min(bad) if bad else -1)
        assert locate.first_not_finite(rows, firsts) == (min(bad) if bad else -1)


@pytest.mark.parametrize(
    ("ratio", "sound"), [(0.1, True), (0.09, False), (-1, False), (10, True), (10.1, False)]
)
def test_volume_ratios_have_bounds(ratio, sound):
    state = sound_state(CHUNK + 1)
    state[-1][CHUNK] = ratio
    assert locate.first_unsound(*state, 0.1, 10.0, np.empty(2, dtype=np.int64)) == (-1 if sound else CHUNK)


def test_numbers_whose_sum_overflows_are_finite():
    rows = np.full((CHUNK, 2), 1e308)
    assert locate.first_not_finite(rows, np.empty(2, dtype=np.int64)) == -1
