"""Python's garbage collector is off while numba compiles.

Compilation creates millions of small objects that live until it ends. The collector would go through all of
them again and again and find nothing, which takes a fifth of the time of a compilation.
"""

from __future__ import annotations

import gc
from typing import Any

from numba.core import event


class _Rest(event.Listener):
    """Switches the collector off during a compilation, and on again if it was on before."""

    def __init__(self) -> None:
        self._depth = 0
        self._was_on = False

    def on_start(self, event: Any) -> None:
        if self._depth == 0:
            self._was_on = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        self._depth -= 1
        if self._depth == 0 and self._was_on:
            gc.enable()


def rest_while_compiling() -> None:
    """Call this once. numba compiles one function at a time in a process; it has a lock for this."""
    event.register("numba:compile", _Rest())
