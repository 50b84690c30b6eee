"""exp, log, powers and cube roots without a branch, so that the compiler can treat eight numbers at once.

The functions of the C library take one number at a time, and cost more than all the rest of a law. The
functions here are plain series after the usual reduction of the argument, exact to a few units in the last
place:

    exp x = 2^n e^r,        r = x - n ln 2,  |r| <= ln(2)/2,     Taylor to r^13
    ln x = k ln 2 + ln m,   m in [√½, √2],   s = (m-1)/(m+1),    ln m = 2 artanh s, Taylor to s^25

Arguments must be finite; those of ``log`` and ``power`` at least ``SMALLEST``. Other arguments give
meaningless numbers.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from .compile import inline
from .vectors import multiply_add

SMALLEST = 2.3e-308
"""Smallest number with full precision, rounded up (smallest normal double)."""

LN2_HIGH = math.ldexp(math.floor(math.ldexp(math.log(2), 32)), -32)
"""The first 32 bits of ln 2, so that n LN2_HIGH is exact."""
LN2_LOW = (math.log(2) - LN2_HIGH) + 2.3190468138462996e-17
"""The rest of ln 2; the last number is the rounding error of ln 2 as a double."""
PER_LN2 = 1 / math.log(2)
ROOT2 = math.sqrt(2)
MANTISSA, BIAS = 52, 1023
FRACTION = (1 << MANTISSA) - 1
ONE = BIAS << MANTISSA
CUBE_START = 0x553E_E072_8F5C_28F6
"""The bits of x^(-1/3) and a third of the bits of x, added up: chosen so that the start of ``cube_root`` has
the same largest error to both sides."""


@intrinsic
def bits(typing, x):
    """The 64 bits of a double as an integer."""

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), generate


@intrinsic
def from_bits(typing, i):
    """The double that has these 64 bits."""

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.int64), generate


@intrinsic
def fused(typing, a, b, c):
    """a b + c, rounded only once if the machine can do this."""

    def generate(context, builder, signature, arguments):
        return multiply_add(builder, *arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


if numba.config.DISABLE_JIT:

    def bits(x):
        return int(np.float64(x).view(np.int64))

    def from_bits(i):
        return float(np.int64(i).view(np.float64))

    def fused(a, b, c):
        return a * b + c


@inline()
def expm1_and_scale(x):
    """e^r - 1 and 2^n, with e^x = 2^n e^r."""
    x = min(max(x, -708.0), 709.0)
    n = math.floor(x * PER_LN2 + 0.5)
    r = fused(-n, LN2_LOW, x - n * LN2_HIGH)
    q = 1 / 6227020800
    q = fused(q, r, 1 / 479001600)
    q = fused(q, r, 1 / 39916800)
    q = fused(q, r, 1 / 3628800)
    q = fused(q, r, 1 / 362880)
    q = fused(q, r, 1 / 40320)
    q = fused(q, r, 1 / 5040)
    q = fused(q, r, 1 / 720)
    q = fused(q, r, 1 / 120)
    q = fused(q, r, 1 / 24)
    q = fused(q, r, 1 / 6)
    q = fused(q, r, 1 / 2)
    return fused(r * r, q, r), from_bits((int(n) + BIAS) << MANTISSA)


@inline()
def exp(x):
    """e^x, with x limited to -708 … 709."""
    part, scale = expm1_and_scale(x)
    return fused(scale, part, scale)


@inline()
def expm1(x):
    """e^x - 1, with full precision near zero."""
    part, scale = expm1_and_scale(x)
    return fused(scale, part, scale - 1.0)


@inline()
def log(x):
    """ln x."""
    i = bits(x)
    exponent = (i >> MANTISSA) - BIAS
    m = from_bits((i & FRACTION) | ONE)
    upper = m > ROOT2
    m = 0.5 * m if upper else m
    k = float(exponent + 1 if upper else exponent)
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    q = 1 / 25
    q = fused(q, z, 1 / 23)
    q = fused(q, z, 1 / 21)
    q = fused(q, z, 1 / 19)
    q = fused(q, z, 1 / 17)
    q = fused(q, z, 1 / 15)
    q = fused(q, z, 1 / 13)
    q = fused(q, z, 1 / 11)
    q = fused(q, z, 1 / 9)
    q = fused(q, z, 1 / 7)
    q = fused(q, z, 1 / 5)
    q = fused(q, z, 1 / 3)
    return fused(k, LN2_HIGH, 2 * s + fused(2 * s * z, q, k * LN2_LOW))


@inline()
def cube_root(x):
    """x^(1/3), of x from zero to 1e300, to a unit or two in the last place.

    Newton's method for x^(-1/3) needs no division. The start is a third of the bits, as a sum of shifts, and
    wrong by 3.7 % at most; each step squares the error and doubles it.
    """
    i = bits(x)
    third = (i >> 2) + (i >> 4)
    third += third >> 4
    third += third >> 8
    y = from_bits(CUBE_START - third)
    third_of_x = x * (1 / 3)
    y *= 4 / 3 - third_of_x * y * y * y
    y *= 4 / 3 - third_of_x * y * y * y
    y *= 4 / 3 - third_of_x * y * y * y
    y *= 4 / 3 - third_of_x * y * y * y
    root = x * y * y
    # The last step is for the root itself, so that its rounding is the only one left.
    return root + (x - root * root * root) * (1 / 3) * y * y


@inline()
def power(x, exponent):
    """x^exponent; its relative error grows with |exponent ln x|."""
    return exp(exponent * log(x))
