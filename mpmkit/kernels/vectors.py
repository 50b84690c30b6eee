"""Vectors of eight doubles: a node's record is one vector, and so is what a particle adds to it.

The compiler would treat a loop over the eight slots of a record as scalar operations. With these functions it
gets vector operations, and LLVM turns them into the widest instructions of the machine. They work only inside
kernels; if compilation is switched off, NumPy arrays replace them.
"""

from __future__ import annotations

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, register_model

LANES = 8

_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_HALF = ir.VectorType(ir.DoubleType(), LANES // 2)
_INT = ir.IntType(32)


class Vector(types.Type):
    """Type of a vector inside a kernel."""

    def __init__(self) -> None:
        super().__init__(name="Vector8")


@register_model(Vector)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _VECTOR)


_vector = Vector()


def _pointer(context, builder, signature, arguments, kind=_VECTOR):
    """Address of ``array.flat[i]`` of a contiguous array, as a pointer to a vector."""
    array, i = signature.args[:2]
    data = context.make_array(array)(context, builder, arguments[0]).data
    index = context.cast(builder, arguments[1], i, types.intp)
    return builder.bitcast(builder.gep(data, [index]), kind.as_pointer())


def _mask(lanes):
    """Constant vector of lane numbers, for a shuffle."""
    return ir.Constant(ir.VectorType(_INT, len(lanes)), list(lanes))


def _spread(builder, scalar):
    nothing = ir.Constant(_VECTOR, ir.Undefined)
    first = builder.insert_element(nothing, scalar, ir.Constant(_INT, 0))
    return builder.shuffle_vector(first, nothing, _mask([0] * LANES))


def multiply_add(builder, a, b, c):
    """a b + c of numbers or vectors, as one instruction if the machine has it.

    It is called by name. If the compiler were free to contract a b + c, it could do so differently in newly
    compiled code and in code from the cache, and the results would differ in their last bits.
    """
    name = "llvm.fmuladd.v8f64" if a.type == _VECTOR else "llvm.fmuladd.f64"
    kind = ir.FunctionType(a.type, [a.type] * 3)
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), [a, b, c])


@intrinsic
def load(typing, array, i):
    """Eight doubles of a contiguous array from its flat index i on. The bounds are not checked."""

    def generate(context, builder, signature, arguments):
        return builder.load(_pointer(context, builder, signature, arguments), align=8)

    return _vector(array, i), generate


@intrinsic(prefer_literal=True)
def load_first(typing, array, i, count):
    """``count`` doubles of a contiguous array from its flat index i on, and zeros; no more are read.
    ``count`` must be a literal number.
    """
    number = count.literal_value

    def generate(context, builder, signature, arguments):
        pointer = _pointer(context, builder, signature, arguments)
        read = ir.Constant(ir.VectorType(ir.IntType(1), LANES), [k < number for k in range(LANES)])
        kind = ir.FunctionType(_VECTOR, [pointer.type, _INT, read.type, _VECTOR])
        masked = cgutils.get_or_insert_function(builder.module, kind, "llvm.masked.load.v8f64.p0")
        return builder.call(masked, [pointer, _INT(8), read, ir.Constant(_VECTOR, [0.0] * LANES)])

    return _vector(array, i, count), generate


@intrinsic
def load_twice(typing, array, i):
    """Four doubles of a contiguous array from its flat index i on, in both halves of a vector."""

    def generate(context, builder, signature, arguments):
        half = builder.load(_pointer(context, builder, signature, arguments, _HALF), align=8)
        return builder.shuffle_vector(half, half, _mask([0, 1, 2, 3] * 2))

    return _vector(array, i), generate


@intrinsic
def store(typing, array, i, vector):
    """Write a vector to a contiguous array, from its flat index i on."""

    def generate(context, builder, signature, arguments):
        builder.store(arguments[2], _pointer(context, builder, signature, arguments), align=8)
        return context.get_dummy_value()

    return types.none(array, i, vector), generate


@intrinsic
def store_half(typing, array, i, vector):
    """Write the first four doubles of a vector to a contiguous array, from its flat index i on."""

    def generate(context, builder, signature, arguments):
        half = builder.shuffle_vector(arguments[2], arguments[2], _mask(range(LANES // 2)))
        builder.store(half, _pointer(context, builder, signature, arguments, _HALF), align=8)
        return context.get_dummy_value()

    return types.none(array, i, vector), generate


@intrinsic
def zero(typing):
    """A vector of zeros."""

    def generate(context, builder, signature, arguments):
        return ir.Constant(_VECTOR, [0.0] * LANES)

    return _vector(), generate


@intrinsic
def scale(typing, factor, vector):
    """factor × vector."""

    def generate(context, builder, signature, arguments):
        return builder.fmul(_spread(builder, arguments[0]), arguments[1])

    return _vector(types.float64, vector), generate


@intrinsic
def plus(typing, total, factor, vector):
    """total + factor × vector, rounded only once if the machine can do this."""

    def generate(context, builder, signature, arguments):
        return multiply_add(builder, _spread(builder, arguments[1]), arguments[2], arguments[0])

    return _vector(total, types.float64, vector), generate


@intrinsic
def multiply(typing, a, b):
    """a b, lane by lane."""

    def generate(context, builder, signature, arguments):
        return builder.fmul(*arguments)

    return _vector(a, b), generate


@intrinsic
def plus_product(typing, total, a, b):
    """total + a b, lane by lane, rounded only once if the machine can do this."""

    def generate(context, builder, signature, arguments):
        return multiply_add(builder, arguments[1], arguments[2], arguments[0])

    return _vector(total, a, b), generate


@intrinsic
def spread(typing, factor):
    """A vector with the same scalar in all eight lanes."""

    def generate(context, builder, signature, arguments):
        return _spread(builder, arguments[0])

    return _vector(types.float64), generate


def picker(*lanes):
    """A function (a, b) → vector for kernels, whose lane k is lane ``lanes[k]`` of the sixteen of a and b."""

    def pick(typing, a, b):
        def generate(context, builder, signature, arguments):
            return builder.shuffle_vector(*arguments, _mask(lanes))

        return _vector(a, b), generate

    pick.__qualname__ = f"picker{lanes}"  # a name of its own: the code of two pickers differs
    return intrinsic(pick)


@intrinsic
def pack(typing, a, b, c, d, e, f, g, h):
    """A vector of eight scalars."""

    def generate(context, builder, signature, arguments):
        vector = ir.Constant(_VECTOR, ir.Undefined)
        for k, scalar in enumerate(arguments):
            vector = builder.insert_element(vector, scalar, ir.Constant(_INT, k))
        return vector

    return _vector(*[types.float64] * LANES), generate


@intrinsic(prefer_literal=True)
def lane(typing, vector, k):
    """Scalar k of a vector; k must be a literal number."""
    number = k.literal_value

    def generate(context, builder, signature, arguments):
        return builder.extract_element(arguments[0], ir.Constant(_INT, number))

    return types.float64(vector, k), generate


if numba.config.DISABLE_JIT:

    def load(array, i):
        found = array.reshape(-1)[i : i + LANES]
        return np.concatenate([found, np.zeros(LANES - len(found))])

    def load_first(array, i, count):
        return np.concatenate([array.reshape(-1)[i : i + count], np.zeros(LANES - count)])

    def load_twice(array, i):
        return np.tile(array.reshape(-1)[i : i + LANES // 2], 2)

    def store(array, i, vector):
        there = array.reshape(-1)[i : i + LANES]
        there[:] = vector[: len(there)]

    def store_half(array, i, vector):
        there = array.reshape(-1)[i : i + LANES // 2]
        there[:] = vector[: len(there)]

    def zero():
        return np.zeros(LANES)

    def scale(factor, vector):
        return factor * vector

    def plus(total, factor, vector):
        return total + factor * vector

    def multiply(a, b):
        return a * b

    def plus_product(total, a, b):
        return total + a * b

    def spread(factor):
        return np.full(LANES, factor)

    def picker(*lanes):
        return lambda a, b: np.concatenate([a, b])[list(lanes)]

    def pack(a, b, c, d, e, f, g, h):
        return np.array([a, b, c, d, e, f, g, h])

    def lane(vector, k):
        return vector[k]
