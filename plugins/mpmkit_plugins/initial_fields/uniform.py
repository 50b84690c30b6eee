"""The same value in a whole body."""

from __future__ import annotations

import numpy as np

from mpmkit.contracts import Beginning, InitialField, Space, hookimpl, quantity

from .sizes import wrong_size


class Uniform(InitialField):
    """The same value everywhere: a number, or a list with the components."""

    name = "uniform"
    api_version = 2
    citation = "none: a definition"

    value: float | list[float] = quantity("unit of the field", "the value, or its components")

    def problem(self, space: Space, field: str, shape: tuple[int, ...]) -> str | None:
        return wrong_size("value", self.value, field, shape)

    def at(self, start: Beginning) -> np.ndarray:
        value = np.array(self.value, dtype=float).reshape(start.shape)
        return np.tile(value, (len(start.position), *(1 for _ in start.shape)))


@hookimpl
def mpmkit_initial_fields() -> list[type[InitialField]]:
    return [Uniform]
