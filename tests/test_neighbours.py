"""The least around each node of a block, shifts of particles, and slopes of fields on a lattice."""

import itertools

import numpy as np
import pytest

from mpmkit.kernels.neighbours import least_around, least_beside
from mpmkit.kernels.shifts import shift
from mpmkit.kernels.splines import SUPPORT, fill_splines, gather_slope
from mpmkit.kernels.vectors import LANES

BLOCKS = [(5, 1, 7), (4, 6, 5)]


def neighbours(values, corners, beyond):
    """Values at all places that are at most one apart, of a block with ``beyond`` around it."""
    reach = [0 if n == 1 else 1 for n in values.shape]
    padded = np.pad(values, [(r, r) for r in reach], constant_values=beyond)
    for offset in itertools.product(*(range(-r, r + 1) for r in reach)):
        if corners or np.abs(offset).sum() <= 1:
            begin = [r + o for r, o in zip(reach, offset, strict=True)]
            yield padded[tuple(slice(b, b + n) for b, n in zip(begin, values.shape, strict=True))]


@pytest.mark.parametrize("shape", BLOCKS)
@pytest.mark.parametrize(
    ("kernel", "corners", "beyond"), [(least_around, True, 0.0), (least_beside, False, np.inf)]
)
def test_the_least_of_all_neighbours(shape, kernel, corners, beyond, each_number_of_threads):
    values = np.random.default_rng(1).uniform(0.5, 2.0, shape)
    found = np.empty(shape)
    kernel(values, found)
    np.testing.assert_array_equal(found, np.min(list(neighbours(values, corners, beyond)), axis=0))


@pytest.mark.parametrize("dim", [2, 3])
def test_a_shift_stops_at_walls_and_velocity_follows(dim, each_number_of_threads):
    rng = np.random.default_rng(2)
    n, low, high = 600, np.full(dim, 0.1), np.full(dim, 0.9)
    before, displacement = rng.uniform(0.0, 1.0, (n, dim)), rng.uniform(-0.3, 0.3, (n, dim))
    displacement[::3] = 0.0
    affine, change = rng.uniform(-1, 1, (n, dim, dim)), np.full((n, dim), np.nan)
    position = before.copy()
    shift(position, displacement, low, high, affine, change)
    np.testing.assert_array_equal(position[::3], before[::3])  # also those that were beyond
    moved = displacement != 0
    np.testing.assert_array_equal(position[moved], np.clip(before + displacement, low, high)[moved])
    np.testing.assert_allclose(
        change, np.einsum("pij,pj->pi", affine, position - before), rtol=1e-12, atol=1e-15
    )


@pytest.mark.parametrize("dim", [2, 3])
def test_the_slope_of_a_linear_field_is_exact(dim, each_number_of_threads):
    """Quadratic splines reproduce it wherever the particles are."""
    rng = np.random.default_rng(3)
    n, nodes, spacing, slope = 500, 9, 0.05, np.array([3.0, -2.0, 0.5])[:dim]
    x = rng.uniform(2 * spacing, (nodes - 3) * spacing, (n, dim))
    places = np.stack(np.meshgrid(*[spacing * np.arange(nodes)] * dim, indexing="ij"), axis=-1)
    field = np.concatenate([(7.0 + places @ slope).ravel(), np.zeros(LANES)])
    strides = (nodes * nodes, nodes, 1) if dim == 3 else (nodes, 1, 1)
    base, weight, found = np.empty((n, dim), np.int32), np.empty((n, dim, SUPPORT)), np.empty((n, dim))
    fill_splines(x, 1 / spacing, base, weight)
    gather_slope(dim)(field, strides, np.zeros(dim, np.int64), base, weight, 1 / spacing, found)
    np.testing.assert_allclose(found, np.broadcast_to(slope, (n, dim)), rtol=1e-11)
