"""Vectors of eight doubles against NumPy, and the kernels made of them where nothing is compiled."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mpmkit.kernels.compile import function
from mpmkit.kernels.vectors import (
    LANES,
    lane,
    load,
    load_first,
    load_twice,
    multiply,
    pack,
    picker,
    plus,
    plus_product,
    scale,
    spread,
    store,
    zero,
)


@function()
def _move(source, i, target, j):
    store(target, j, load(source, i))


@function()
def _combine(x, y, factor, out):
    u, v = load(x, 0), load(y, 0)
    store(out, 0, scale(factor, u))
    store(out, LANES, plus(u, factor, v))
    store(out, 2 * LANES, plus(zero(), factor, v))


@function()
def _reverse(x, out):
    v = load(x, 0)
    store(
        out,
        0,
        pack(lane(v, 7), lane(v, 6), lane(v, 5), lane(v, 4), lane(v, 3), lane(v, 2), lane(v, 1), lane(v, 0)),
    )


@pytest.mark.parametrize(("i", "j"), [(0, 0), (3, 8), (16, 1), (24, 24)])
def test_load_and_store_move_eight_doubles_at_any_flat_index(i, j):
    rng = np.random.default_rng(1)
    source, target = rng.normal(size=(4, LANES)), rng.normal(size=(16, 2))
    expected = target.copy()
    expected.reshape(-1)[j : j + LANES] = source.reshape(-1)[i : i + LANES]
    _move(source, i, target, j)
    np.testing.assert_array_equal(target, expected)


def test_scale_and_plus():
    x, y = np.random.default_rng(2).normal(size=(2, LANES))
    out, factor = np.empty((3, LANES)), 0.7
    _combine(x, y, factor, out)
    np.testing.assert_array_equal(out[[0, 2]], [factor * x, factor * y])
    np.testing.assert_allclose(out[1], x + factor * y, rtol=0, atol=1e-15)  # may be one fused operation


MIXED = 15, 0, 8, 7, 3, 3, 12, 1
_mixed, _evens = picker(*MIXED), picker(0, 2, 4, 6, 8, 10, 12, 14)


@function()
def _pick(x, y, factor, out):
    u, v = load(x, 0), load(y, 0)
    store(out, 0, _mixed(u, v))
    store(out, LANES, _evens(u, v))
    store(out, 2 * LANES, multiply(u, v))
    store(out, 3 * LANES, plus_product(u, u, v))
    store(out, 4 * LANES, spread(factor))


def test_products_and_picked_lanes():
    x, y = np.random.default_rng(3).normal(size=(2, LANES))
    out, both = np.empty((5, LANES)), np.concatenate([x, y])
    _pick(x, y, 0.7, out)
    np.testing.assert_array_equal(out[[0, 1, 2]], [both[list(MIXED)], both[::2], x * y])
    np.testing.assert_allclose(out[3], x + x * y, rtol=0, atol=1e-15)  # may be one fused operation
    np.testing.assert_array_equal(out[4], 0.7)


@function()
def _load_parts(x, i, out):
    store(out, 0, load_first(x, i, 3))
    store(out, LANES, load_first(x, i, 6))
    store(out, 2 * LANES, load_twice(x, i))


def test_load_first_leaves_what_follows_and_load_twice_repeats():
    x, out = np.arange(40.0), np.empty((3, LANES))
    x[20:] = np.nan
    _load_parts(x, 14, out)
    np.testing.assert_array_equal(out[0], [14, 15, 16, 0, 0, 0, 0, 0])
    np.testing.assert_array_equal(out[1], [14, 15, 16, 17, 18, 19, 0, 0])
    np.testing.assert_array_equal(out[2], [14, 15, 16, 17] * 2)


def test_pack_and_lane_keep_the_order():
    x, out = np.arange(LANES) + 0.5, np.empty(LANES)
    _reverse(x, out)
    np.testing.assert_array_equal(out, x[::-1])


def test_a_scalar_beyond_a_number_stays_in_its_lane():
    """Zero times NaN is NaN, so a NaN may only affect its own lane."""
    x, out = np.ones(LANES), np.empty((3, LANES))
    x[3], x[5] = np.nan, np.inf
    _combine(x, np.ones(LANES), 0.5, out)
    assert (np.isfinite(out[1]) == np.isfinite(x)).all()


UNCOMPILED = """
import numba
import numpy as np
from test_transfers import NODE, Scene, gathered

assert numba.config.DISABLE_JIT
for dim in (2, 3):
    scene = Scene(dim, 3, n=9, affine=True)
    found = np.zeros((scene.count, NODE))
    scene.scatter(found, True, True)
    np.testing.assert_allclose(found, scene.reference(True, True), rtol=0, atol=1e-12)
    grid = scene.rng.normal(size=(scene.count, NODE))
    new, _, L, C = gathered(scene, grid)
    scene.gather(grid, move=True, strain=True, affine=True)
    np.testing.assert_allclose(scene.velocity, new, rtol=0, atol=1e-12)
    np.testing.assert_allclose(scene.velocity_gradient[:, :dim, :dim], L[:, :dim, :dim], rtol=0, atol=1e-12)
    np.testing.assert_allclose(scene.affine, C, rtol=0, atol=1e-12)

from mpmkit.kernels import elementary
for x in (0.3, 2.0, 1e-5, 700.0):
    found = elementary.exp(x), elementary.expm1(-x), elementary.log(x), elementary.power(x, 0.5)
    np.testing.assert_allclose(found, [np.exp(x), np.expm1(-x), np.log(x), x**0.5], rtol=1e-14)
"""


def test_kernels_run_uncompiled():
    """For a debugger: NUMBA_DISABLE_JIT=1, and NumPy stands in for what only a compiler has."""
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-c", UNCOMPILED]
    done = subprocess.run(
        command, cwd=Path(__file__).parent, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


BEYOND = """
import numpy as np
from mpmkit.kernels import tensors
tensors.determinant(np.tile(np.eye(3), (700, 1, 1)), np.zeros(300))
"""


@pytest.mark.parametrize("variable", ["NUMBA_BOUNDSCHECK", "NUMBA_DISABLE_JIT"])
def test_a_write_beyond_an_array_is_seen_where_continuous_integration_looks_for_it(variable, tmp_path):
    """In a parallel loop, where it is silent otherwise: else the jobs that run with either prove nothing."""
    environment = {**os.environ, variable: "1", "NUMBA_CACHE_DIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", BEYOND], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "out of bounds" in done.stderr
