"""What a run needs: a compiled function, and the types of the arguments of its call, as text.

As text it can be kept in a file, and another process can compile it.
"""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numba
import numpy as np
from numba import types as numba_types
from numba.core.dispatcher import Dispatcher


class Unnamed(Exception):
    """A function or a type that cannot be written as text."""


@dataclass(frozen=True)
class Need:
    """A function of a module, with the types of its arguments.

    If another function makes this function, ``name`` is ``<maker>.<locals>.<function>``, and ``made_with``
    are the arguments of its maker.
    """

    module: str
    name: str
    made_with: Mapping[str, int]
    types: Sequence[str]

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)

    def function(self) -> Dispatcher:
        """The function; this does not compile it.

        Raises:
            Unnamed: there is no such function.
        """
        try:
            module = importlib.import_module(self.module)
            maker, _, made = self.name.partition(".<locals>.")
            found = getattr(module, maker)
            found = found(**self.made_with) if made else found
        except Exception as error:
            raise Unnamed(f"{self.module}.{self.name}") from error
        if not isinstance(found, Dispatcher) or found.py_func.__qualname__ != self.name:
            raise Unnamed(f"{self.module}.{self.name}")
        return found

    def signature(self) -> tuple[numba_types.Type, ...]:
        """The types as objects of numba."""
        return tuple(map(_type, self.types))


def need_of(function: Dispatcher, signature: Sequence[numba_types.Type]) -> Need:
    """A function and the types of its arguments, as text.

    Raises:
        Unnamed: one of them cannot be written as text.
    """
    python = function.py_func
    maker, _, made = python.__qualname__.partition(".<locals>.")
    values: dict[str, int] = {}
    if made:
        closed = inspect.getclosurevars(python).nonlocals
        wanted = inspect.signature(getattr(importlib.import_module(python.__module__), maker)).parameters
        values = {name: closed[name] for name in wanted if type(closed.get(name)) in (int, bool)}
    return Need(python.__module__, python.__qualname__, values, tuple(map(_text, signature)))


def _text(kind: numba_types.Type) -> str:
    """``float64``, ``float64 2 C`` for an array with two axes in C order, or ``tuple 3 int64`` for three
    integers."""
    if isinstance(kind, numba_types.UniTuple):
        return f"tuple {kind.count} {_text(kind.dtype)}"
    if (
        isinstance(kind, numba_types.Array)
        and kind.aligned
        and not isinstance(kind.dtype, numba_types.Record)
    ):
        return f"{_text(kind.dtype)} {kind.ndim} {kind.layout}{'' if kind.mutable else ' readonly'}"
    if isinstance(kind, numba_types.Integer | numba_types.Float | numba_types.Boolean) and not isinstance(
        kind, numba_types.Literal
    ):
        return str(kind)
    raise Unnamed(str(kind))


def _type(text: str) -> numba_types.Type:
    name, *array = text.split()
    if name == "tuple":
        return numba_types.UniTuple(_type(" ".join(array[1:])), int(array[0]))
    scalar = numba.from_dtype(np.dtype(name))
    if not array:
        return scalar
    return numba_types.Array(scalar, int(array[0]), array[1], readonly=array[2:] == ["readonly"])
