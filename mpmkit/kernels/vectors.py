"""Eight doubles at once: a node's record is one vector, and so is what a particle adds to it.

numba leaves a loop over eight slots to the compiler, which keeps them apart as scalars. These few functions
say it in so many words; LLVM turns them into the widest instructions that the machine has. They work inside
kernels only; where compilation is switched off, NumPy arrays stand in.
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


def _pointer(context, builder, signature, arguments):
    """Address of ``array.flat[i]`` of a contiguous array, as that of a vector."""
    array, i = signature.args[:2]
    data = context.make_array(array)(context, builder, arguments[0]).data
    index = context.cast(builder, arguments[1], i, types.intp)
    return builder.bitcast(builder.gep(data, [index]), _VECTOR.as_pointer())


def _spread(builder, scalar):
    nothing = ir.Constant(_VECTOR, ir.Undefined)
    first = builder.insert_element(nothing, scalar, ir.Constant(_INT, 0))
    return builder.shuffle_vector(first, nothing, ir.Constant(ir.VectorType(_INT, LANES), [0] * LANES))


def multiply_add(builder, a, b, c):
    """a b + c of numbers or vectors, as one instruction where the machine has it.

    It is asked for by name, and not left to the compiler's freedom to contract: of a kernel there are two
    versions, one that has just been compiled and one that was kept, and what it contracts differs in them.
    """
    name = "llvm.fmuladd.v8f64" if a.type == _VECTOR else "llvm.fmuladd.f64"
    kind = ir.FunctionType(a.type, [a.type] * 3)
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), [a, b, c])


@intrinsic
def load(typing, array, i):
    """Eight doubles of a contiguous array from its flat index i on. Nobody checks that they are there."""

    def generate(context, builder, signature, arguments):
        return builder.load(_pointer(context, builder, signature, arguments), align=8)

    return _vector(array, i), generate


@intrinsic
def store(typing, array, i, vector):
    """Write a vector to a contiguous array, from its flat index i on."""

    def generate(context, builder, signature, arguments):
        builder.store(arguments[2], _pointer(context, builder, signature, arguments), align=8)
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
    """total + factor × vector, rounded once where the machine can."""

    def generate(context, builder, signature, arguments):
        return multiply_add(builder, _spread(builder, arguments[1]), arguments[2], arguments[0])

    return _vector(total, types.float64, vector), generate


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
    """Scalar k of a vector; k must be written as a number."""
    number = k.literal_value

    def generate(context, builder, signature, arguments):
        return builder.extract_element(arguments[0], ir.Constant(_INT, number))

    return types.float64(vector, k), generate


if numba.config.DISABLE_JIT:

    def load(array, i):
        found = array.reshape(-1)[i : i + LANES]
        return np.concatenate([found, np.zeros(LANES - len(found))])

    def store(array, i, vector):
        there = array.reshape(-1)[i : i + LANES]
        there[:] = vector[: len(there)]

    def zero():
        return np.zeros(LANES)

    def scale(factor, vector):
        return factor * vector

    def plus(total, factor, vector):
        return total + factor * vector

    def pack(a, b, c, d, e, f, g, h):
        return np.array([a, b, c, d, e, f, g, h])

    def lane(vector, k):
        return vector[k]
