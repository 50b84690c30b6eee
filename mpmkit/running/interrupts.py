"""Ctrl-C and the signals of batch systems, delayed until a step is done."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

OF_BATCH_SYSTEMS = tuple(
    getattr(signal, name)
    for name in ("SIGTERM", "SIGHUP", "SIGXCPU", "SIGUSR1", "SIGUSR2")
    if hasattr(signal, name)  # Windows has only the first
)
"""Signals for a process whose time is over, whose terminal was closed, or that will be ended soon."""
SIGNALS = (signal.SIGINT, *OF_BATCH_SYSTEMS)


def take_signals_as_interrupts() -> None:
    """Treat the signals of batch systems like Ctrl-C; ignored signals, e.g. by nohup, stay ignored."""
    for number in OF_BATCH_SYSTEMS:
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)


@contextmanager
def held_interrupts() -> Iterator[Callable[[], bool]]:
    """Inside the block, a first interrupt is only recorded, and a second one interrupts.

    Yields a function that tells whether an interrupt has come. A signal that the process ignores, or handles
    itself, is not changed; outside the main thread, no signal is changed.
    """
    came: list[int] = []

    def hold(number: int, frame: Any) -> None:
        if came:
            raise KeyboardInterrupt
        came.append(number)

    held = []
    if threading.current_thread() is threading.main_thread():
        held = [number for number in SIGNALS if signal.getsignal(number) is signal.default_int_handler]
    for number in held:
        signal.signal(number, hold)
    try:
        yield lambda: bool(came)
    finally:
        for number in held:
            signal.signal(number, signal.default_int_handler)
