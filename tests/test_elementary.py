"""exp, expm1, log, powers and cube roots against NumPy in a longer format; errors in units of the last
place."""

from __future__ import annotations

import sys

import numba
import numpy as np
import pytest

from mpmkit.kernels import elementary
from mpmkit.kernels.compile import function
from mpmkit.kernels.elementary import SMALLEST

FEW = 2.5 if np.finfo(np.longdouble).eps < 1e-18 else 4.0
"""ulp; NumPy's own double functions may be off by one themselves."""
LARGEST = sys.float_info.max


@function()
def _exp(x, out):
    for i in range(len(x)):
        out[i] = elementary.exp(x[i])


@function()
def _expm1(x, out):
    for i in range(len(x)):
        out[i] = elementary.expm1(x[i])


@function()
def _log(x, out):
    for i in range(len(x)):
        out[i] = elementary.log(x[i])


@function()
def _power(x, exponent, out):
    for i in range(len(x)):
        out[i] = elementary.power(x[i], exponent)


@function()
def _cube_root(x, out):
    for i in range(len(x)):
        out[i] = elementary.cube_root(x[i])


def call(function, x, *more):
    out = np.empty(len(x))
    function(np.asarray(x, dtype=float), *more, out)
    return out


def ulps(found, exact):
    """Error in units in the last place of the exact value."""
    return np.abs((found - exact) / np.spacing(np.abs(exact.astype(float)))).astype(float)


def spread(rng, low, high, n=30_000):
    """Numbers of both signs, evenly spread over all magnitudes from 10^low to 10^high."""
    return rng.choice([-1, 1], n) * 10 ** rng.uniform(low, high, n)


def arguments(rng):
    edges = [-708.0, 709.0, 0.0, 5e-324, -5e-324, SMALLEST, -1e-300, *(np.arange(-3, 4) * np.log(2) / 2)]
    return np.concatenate([rng.uniform(-708, 709, 30_000), rng.uniform(-2, 2, 30_000), edges])


def test_exp():
    x = arguments(np.random.default_rng(1))
    assert ulps(call(_exp, x), np.exp(x.astype(np.longdouble))).max() < FEW


def test_expm1():
    """To all digits near zero too, of either sign, where e^x - 1 itself would lose them."""
    rng = np.random.default_rng(2)
    x = np.concatenate([arguments(rng), spread(rng, -307, 0)])
    assert ulps(call(_expm1, x), np.expm1(x.astype(np.longdouble))).max() < FEW


@pytest.mark.parametrize(("x", "taken"), [(-708.5, -708.0), (-1e300, -708.0), (709.5, 709.0), (1e300, 709.0)])
def test_exponents_beyond_the_range_are_taken_at_its_ends(x, taken):
    assert call(_exp, [x]) == call(_exp, [taken])
    assert call(_expm1, [x]) == call(_expm1, [taken])
    assert np.isfinite(call(_exp, [x])).all()


def test_log():
    """From the least number with all its digits to the largest; near one to all digits."""
    rng = np.random.default_rng(3)
    edges = [SMALLEST, LARGEST, np.sqrt(2), np.sqrt(0.5), np.nextafter(np.sqrt(2), 2), 2.0, 0.5]
    around_one = 1 + spread(rng, -15.5, -1)
    x = np.concatenate(
        [10 ** rng.uniform(-307.5, 308.2, 30_000), rng.uniform(0.4, 2.5, 30_000), around_one, edges]
    )
    x = x[x != 1.0]
    assert ulps(call(_log, x), np.log(x.astype(np.longdouble))).max() < FEW
    assert call(_log, [1.0]) == 0.0


@pytest.mark.parametrize("exponent", [-1.0, -0.67, 0.0, 0.01, 0.33, 1.0, 1.33, 3.0])
def test_power(exponent):
    """An error in ln x is one in the result as large as |exponent ln x|."""
    rng = np.random.default_rng(4)
    x = np.concatenate([10 ** rng.uniform(-90, 90, 30_000), rng.uniform(0.5, 2, 30_000), [1.0]])
    exact = x.astype(np.longdouble) ** np.longdouble(exponent)
    error = np.abs(call(_power, x, exponent) / exact - 1) / np.finfo(float).eps
    assert (error < FEW * (1 + np.abs(exponent * np.log(x)))).all()
    assert call(_power, [1.0], exponent) == 1.0


def test_cube_root():
    """Of all positive numbers but the very largest and least; that of zero is zero."""
    rng = np.random.default_rng(5)
    x = np.concatenate([10 ** rng.uniform(-300, 300, 30_000), rng.uniform(0.5, 8, 30_000), [1.0, 8.0, 27.0]])
    assert ulps(call(_cube_root, x), np.cbrt(x.astype(np.longdouble))).max() < FEW
    assert call(_cube_root, [0.0]) == 0.0


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="only compiled code makes a whole number of none")
@pytest.mark.parametrize("function", [_exp, _expm1], ids=["exp", "expm1"])
def test_what_is_no_number_stays_none(function):
    assert np.isnan(call(function, [np.nan])).all()
