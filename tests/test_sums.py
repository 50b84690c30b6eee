"""Sums over particles, against plain NumPy, and the same with any number of threads."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from mpmkit.kernels import sums
from mpmkit.kernels.compile import CHUNK


def particles(n, dim):
    rng = np.random.default_rng(n + dim)
    return rng.uniform(0.5, 2.0, n), rng.normal(size=(n, dim))


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("n", [1, CHUNK, 3 * CHUNK + 1])
def test_sums_are_those_of_numpy(n, dim):
    mass, velocity = particles(n, dim)
    along = np.array([0.3, -2.0, 0.7])[:dim]
    square = (velocity**2).sum(axis=1)
    assert sums.product(mass, square) == pytest.approx((mass * square).sum(), rel=1e-13)
    assert sums.moment(mass, velocity, along) == pytest.approx(
        (mass * (velocity @ along)).sum(), abs=1e-13 * mass.sum() * 10
    )
    expected = mass.sum(), (mass * square).sum(), square.max()
    assert sums.kinetics(mass, velocity) == pytest.approx(expected, rel=1e-13)


def test_sums_have_the_same_bits_with_one_thread_and_with_all():
    mass, velocity = particles(40 * CHUNK + 7, 3)
    found = []
    for threads in (1, numba.config.NUMBA_NUM_THREADS):
        numba.set_num_threads(threads)
        found.append(
            (
                sums.product(mass, mass),
                sums.moment(mass, velocity, velocity[0]),
                *sums.kinetics(mass, velocity),
            )
        )
    assert found[0] == found[1]


def test_a_speed_that_is_no_number_shows_in_the_sum():
    mass, velocity = particles(10, 3)
    velocity[4, 1] = np.nan
    assert np.isnan(sums.kinetics(mass, velocity)[1])
