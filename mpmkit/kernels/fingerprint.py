"""A key of everything that is compiled into a function: equal keys mean the same machine code.

numba compiles the current values of the globals of a function, of its closure and of the functions that it
calls. So the key is made of all of these values, at the time of compilation, for every function that is
called, from any package: a constant may have been read from a data file or from the environment.
"""

from __future__ import annotations

import builtins
import dis
import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from types import CodeType, ModuleType
from typing import Any

import numba
import numpy as np
from numba import types
from numba.core.caching import NullCache
from numba.core.dispatcher import Dispatcher
from numba.extending import _Intrinsic

PLAIN = (bool, int, float, complex, str, bytes, type(None), type(...))
"""Classes whose ``repr`` describes the value completely."""
PLAIN_TYPES = (types.Number, types.Boolean, types.NoneType, types.UnicodeType, types.Literal, types.Omitted)
"""Types of numba whose ``repr`` is complete. That of a function, in contrast, holds its memory address."""
KNOWN = ("builtins", "math", "cmath", "operator", "numpy", "numba")
"""Packages whose functions and modules are identified by name: numba has its own code for them."""
OPTIONS = ("BOUNDSCHECK", "OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE")
"""Settings (``NUMBA_…`` in the environment) that change the compiled code."""


class Unknown(Exception):
    """There is no key, so that the code must not be kept."""


def fingerprint(function: Dispatcher) -> str:
    """Key of a compiled function: of its code, its constants and all that it calls, as they are now.

    Raises:
        Unknown: something is compiled into it whose change cannot be seen, such as a plain Python function:
            numba may have been given any code for it (``numba.extending.overload``).
    """
    return _Walk().function(function)


def signature_key(arguments: Iterable[types.Type], options: Iterable[str] = OPTIONS) -> str:
    """Key of the types that a function is compiled for, and of the compiler's settings.

    Raises:
        Unknown: the name of a type does not describe it completely.
    """
    settings = [f"{name}={getattr(numba.config, name)}" for name in options]
    return _hash([*settings, *map(_type, arguments)])


class _Walk:
    """One walk through a function and all that it calls."""

    def __init__(self) -> None:
        self._inside: list[Dispatcher] = []
        self._known: dict[Dispatcher, str] = {}

    def function(self, function: Dispatcher) -> str:
        if function in self._inside:  # it calls itself
            return str(len(self._inside) - self._inside.index(function))
        if function not in self._known:
            self._inside.append(function)
            self._known[function] = _hash(self._content(function))
            self._inside.pop()
            compiled_with = getattr(_cache(function), "compiled_with", None)
            if compiled_with not in (None, self._known[function]):
                raise Unknown(f"{function} was compiled before its globals changed")
        return self._known[function]

    def key(self, value: Any) -> str:
        return _hash([f"{type(value).__module__}.{type(value).__qualname__}", *self._words(value)])

    def _words(self, value: Any) -> Iterator[str]:
        if type(value) in PLAIN:
            yield repr(value)
        elif isinstance(value, tuple):
            yield repr(getattr(value, "_fields", None))
            yield from map(self.key, value)
        elif isinstance(value, set | frozenset):
            yield from sorted(map(self.key, value))
        elif isinstance(value, dict):
            yield from sorted(map(self.key, value.items()))
        elif isinstance(value, np.ndarray | np.generic):
            yield _array(np.asarray(value))
        elif isinstance(value, np.dtype):
            yield repr(value)
        elif isinstance(value, types.Type):
            yield _type(value)
        elif isinstance(value, CodeType):
            yield from self._code(value)
        elif isinstance(value, Dispatcher):
            yield self.function(value)
        else:
            yield _name(value)

    def _content(self, function: Dispatcher) -> Iterator[str]:
        if not isinstance(_cache(function), NullCache):
            raise Unknown(f"{function} is kept by numba itself, which checks only its own file")
        python = function.py_func
        yield self.key(python.__code__)
        yield self.key((python.__defaults__, python.__kwdefaults__))
        yield self.key((function.targetoptions, function.locals))
        for cell in python.__closure__ or ():
            try:
                yield self.key(cell.cell_contents)
            except ValueError:
                raise Unknown(f"{function} uses a variable of its closure that has no value yet") from None
        for name, attributes in _globals(python.__code__):
            found = python.__globals__.get(name, getattr(builtins, name, None))
            yield name
            yield self._module(found, attributes) if isinstance(found, ModuleType) else self.key(found)

    def _module(self, module: ModuleType, attributes: tuple[str, ...]) -> str:
        """Key of these attributes of a module: ``constants.VISCOSITY`` is a constant too."""
        if _is_known(module.__name__):
            return module.__name__
        found = [(name, getattr(module, name)) for name in attributes if hasattr(module, name)]
        return _hash(
            self._module(value, attributes) if isinstance(value, ModuleType) else self.key((name, value))
            for name, value in found
        )

    def _code(self, code: CodeType) -> Iterator[str]:
        yield code.co_code.hex()
        yield repr((code.co_argcount, code.co_flags, code.co_names, code.co_varnames, code.co_freevars))
        yield from map(self.key, code.co_consts)


@cache
def _globals(code: CodeType) -> list[tuple[str, tuple[str, ...]]]:
    """Globals that a code object and its inner functions use, and all names of attributes in it."""
    names: dict[str, None] = {}
    attributes = set(code.co_names)
    for instruction in dis.get_instructions(code):
        if instruction.opname in ("LOAD_GLOBAL", "LOAD_NAME"):
            names[instruction.argval] = None
    inner = [found for part in code.co_consts if isinstance(part, CodeType) for found in _globals(part)]
    for name, more in inner:
        names[name] = None
        attributes.update(more)
    return [(name, tuple(sorted(attributes))) for name in names]


def _cache(function: Dispatcher) -> object:
    return function._cache  # type: ignore[attr-defined]


def _array(array: np.ndarray) -> str:
    if array.dtype.hasobject:
        raise Unknown("an array of objects")
    layout = f"{array.dtype.descr} {array.shape} {array.flags.c_contiguous} {array.flags.f_contiguous}"
    return f"{layout} {hashlib.sha256(array.tobytes()).hexdigest()}"


def _type(kind: types.Type) -> str:
    parts = kind.types if type(kind) is types.Tuple else (kind.dtype,) if type(kind) is types.UniTuple else ()
    parts = (kind.dtype,) if isinstance(kind, types.Array) else parts
    if not (isinstance(kind, PLAIN_TYPES) or parts or isinstance(kind, types.Record)):
        raise Unknown(f"the type {kind}")
    return _hash([repr(kind), *map(_type, parts)])


def _name(value: Any) -> str:
    """Name of a function or class of ``KNOWN``, or of an intrinsic of ours, whose source is in the digest."""
    module = str(getattr(value, "__module__", None))
    name = getattr(value, "__qualname__", getattr(value, "__name__", None))
    ours = isinstance(value, _Intrinsic) and module.startswith(f"{__package__}.")
    if name is None or not (ours or _is_known(module)):
        raise Unknown(f"{value!r}")
    return f"{module}.{name}"


def _is_known(module: str) -> bool:
    return module.partition(".")[0] in KNOWN


def _hash(words: Iterable[str]) -> str:
    total = hashlib.sha256()
    for word in words:
        total.update(f"{len(word)} {word}".encode())
    return total.hexdigest()
