"""The one way to have state: a component gives its state as arrays, and takes it back.

Each class knows its own state. What is made of components goes through them by name, in one loop. So a new
component, or a new number in an old one, is in the next checkpoint, and there is no list to keep up to date.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np

State = dict[str, np.ndarray]
"""Arrays by name; a number or a text is an array without axes."""
PLAIN = bool | int | float | str | np.generic | np.ndarray
"""What an attribute may be to be written as an array."""
NOTHING = np.zeros(0, dtype=bool)
"""How ``None`` is written as an array."""


@runtime_checkable
class Stateful(Protocol):
    """What changes during a run, and has to be known for the run to go on."""

    def state(self) -> State:
        """The present state; its arrays may be views."""

    def restore(self, state: State) -> None:
        """Take a state back, in an object that was made of the same case; the arrays are copied.

        Raises:
            KeyError: the state lacks something.
        """


def state_of(components: Mapping[str, Stateful]) -> State:
    """The states of several components in one, each entry as ``component/name``."""
    return {
        f"{name}/{key}": value
        for name, component in components.items()
        for key, value in component.state().items()
    }


def restore(components: Mapping[str, Stateful], state: State) -> None:
    """Give each component its part of a state, in their order."""
    for name, component in components.items():
        prefix = f"{name}/"
        component.restore(
            {key.removeprefix(prefix): value for key, value in state.items() if key.startswith(prefix)}
        )


def plain_state(owner: Any, but: tuple[str, ...] = ()) -> State:
    """Every attribute that is a number, a text, an array or None, except those named in ``but``."""
    return {
        name: NOTHING if value is None else np.asarray(value)
        for name, value in vars(owner).items()
        if name not in but and (value is None or isinstance(value, PLAIN))
    }


def restore_plain(owner: Any, state: State) -> None:
    """Set the attributes that ``plain_state`` gave; what a component adds to them has a ``/`` in its name."""
    for name, value in state.items():
        if "/" in name:
            continue
        if name not in vars(owner):
            raise KeyError(name)
        setattr(owner, name, value_of(value))


def value_of(array: np.ndarray) -> Any:
    """The attribute that an array of ``plain_state`` stands for."""
    if array.dtype == bool and array.shape == (0,):
        return None
    return array.item() if array.ndim == 0 else array.copy()
