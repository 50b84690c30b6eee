"""Copies of arrays between bands of memory that must not change."""

from __future__ import annotations

import numpy as np

from ...contracts import Plugin
from ...errors import PluginFault

SAMPLE = 500
"""Largest number of particles of a trial call."""
BAND = 16
"""Rows of a band; an index slightly out of range is detected, one that is far out of range is not."""
READ, WRITTEN = 0xFF, 0x3F
"""Byte that fills the bands. In arrays that are read it makes NaN, so that a read there shows in the result.
In arrays that are written it makes 5e-4, because adding to NaN would not change it."""


class Fenced:
    """A copy of rows of an array between two bands."""

    def __init__(self, rows: np.ndarray, filling: int) -> None:
        self._store = np.empty((len(rows) + 2 * BAND, *rows.shape[1:]), rows.dtype)
        self._store.view(np.uint8)[...] = filling
        self._bands = np.concatenate([self._store[:BAND], self._store[-BAND:]]).tobytes()
        self.rows = self._store[BAND:-BAND]
        self.rows[...] = rows
        self._given = self.rows.tobytes()

    @property
    def intact(self) -> bool:
        """Whether the bands are unchanged."""
        return np.concatenate([self._store[:BAND], self._store[-BAND:]]).tobytes() == self._bands

    @property
    def changed(self) -> bool:
        """Whether the rows have changed."""
        return self.rows.tobytes() != self._given


def sample(n: int) -> np.ndarray:
    """Indices of at most ``SAMPLE`` of n particles, from the first to the last."""
    return np.linspace(0, n - 1, min(n, SAMPLE)).astype(np.int64)


def require_intact(plugin: Plugin, arrays: dict[str, Fenced]) -> None:
    """Raise PluginFault if a plug-in wrote beyond the ends of an array."""
    for name, array in arrays.items():
        if not array.intact:
            raise PluginFault(plugin, f"wrote beyond the ends of the array '{name}'")


def require_unchanged(plugin: Plugin, given: dict[str, Fenced]) -> None:
    """Raise PluginFault if a plug-in wrote to an array that it may only read."""
    require_intact(plugin, given)
    for name, array in given.items():
        if array.changed:
            raise PluginFault(plugin, f"changed '{name}', which it may only read")
