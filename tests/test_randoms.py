"""Random numbers of particles: uniform, independent, and the same for the same number and time."""

from __future__ import annotations

import numpy as np
import pytest

from mpmkit.kernels.randoms import uniform

COUNT, DIM = 40_000, 3
NOISE = 4 / np.sqrt(COUNT)
"""Four standard deviations of a mean of COUNT numbers whose variance is 1."""


@pytest.fixture(scope="module")
def numbers():
    return np.arange(COUNT)


def test_they_are_uniform_from_minus_1_to_1(numbers):
    found = uniform(numbers, 0.25, DIM)
    assert found.shape == (COUNT, DIM)
    assert -1 <= found.min() < -0.999
    assert 0.999 < found.max() <= 1
    counts, _ = np.histogram(found, 20, (-1, 1))
    expected = COUNT * DIM / 20
    assert ((counts - expected) ** 2 / expected).sum() < 43.8  # χ², 19 degrees of freedom: 1 in 1000


@pytest.mark.parametrize("times", [(0.25, 0.25 + 1e-9), (0.0, 1.0)])
def test_particles_axes_and_times_are_independent(numbers, times):
    first, second = (np.sqrt(3) * uniform(numbers, time, DIM) for time in times)  # variance 1
    pairs = [(first[:, 0], first[:, 1]), (first[:, 0], first[:, 2]), (first[:-1, 0], first[1:, 0])]
    pairs += [(first[:-1, 1], first[1:, 0]), (first[:, 0], second[:, 0]), (first[:-1, 0], second[1:, 0])]
    for one, other in pairs:
        assert abs((one * other).mean()) < NOISE


def test_a_particle_has_its_number_wherever_it_is_kept(numbers):
    order = np.random.default_rng(1).permutation(COUNT)
    np.testing.assert_array_equal(uniform(numbers[order], 0.5, DIM), uniform(numbers, 0.5, DIM)[order])
    np.testing.assert_array_equal(uniform(numbers[:7], 0.5, DIM), uniform(numbers, 0.5, DIM)[:7])
