"""The common interface of components with state: they give their state as arrays and restore it.

Each class knows its own state. A composite saves its components by name in one loop. So a new component, or a
new number in an old one, is in the next checkpoint automatically; there is no list to keep up to date.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np

State = dict[str, np.ndarray]
"""Arrays by name; a number or a text is an array without axes."""
PLAIN = bool | int | float | str | np.generic | np.ndarray
"""Types of attributes that can be written as an array."""
NOTHING = np.zeros(0, dtype=bool)
"""The array that represents ``None``."""


@runtime_checkable
class Stateful(Protocol):
    """An object with data that change during a run and are needed to continue it."""

    def state(self) -> State:
        """The present state; its arrays may be views."""

    def restore(self, state: State) -> None:
        """Restore a state, in an object made from the same case; the arrays are copied.

        Raises:
            KeyError: an entry of the state is missing.
        """


def state_of(components: Mapping[str, Stateful]) -> State:
    """The states of several components in one dict, with keys ``component/name``."""
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
    """Set the attributes from ``plain_state``; entries of components have a ``/`` in their names."""
    for name, value in state.items():
        if "/" in name:
            continue
        if name not in vars(owner):
            raise KeyError(name)
        setattr(owner, name, value_of(value))


def value_of(array: np.ndarray) -> Any:
    """The value of the attribute for an array of ``plain_state``."""
    if array.dtype == bool and array.shape == (0,):
        return None
    return array.item() if array.ndim == 0 else array.copy()
