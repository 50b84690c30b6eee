"""Ctrl-C, and the signals by which batch systems end a run, held back until a step is done."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

OF_BATCH_SYSTEMS = tuple(
    getattr(signal, name)
    for name in ("SIGTERM", "SIGHUP", "SIGXCPU", "SIGUSR1", "SIGUSR2")
    if hasattr(signal, name)  # Windows has the first alone
)
"""What a process gets whose time is up, whose terminal is gone, or that is warned of its end."""
SIGNALS = (signal.SIGINT, *OF_BATCH_SYSTEMS)


def take_signals_as_interrupts() -> None:
    """Let the signals of batch systems do what Ctrl-C does; what is ignored, as by nohup, stays ignored."""
    for number in OF_BATCH_SYSTEMS:
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)


@contextmanager
def held_interrupts() -> Iterator[Callable[[], bool]]:
    """Inside the block a first interrupt waits to be asked for, and a second one interrupts.

    Yields a function that says whether one has come. A signal that the process ignores, or has a handler of
    its own for, stays as it is; so do all of them outside the main thread.
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
