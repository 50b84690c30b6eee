"""The progress of a run that Python has started: a bar in a notebook, or on a terminal."""

from __future__ import annotations

import sys
from html import escape
from typing import Any

from ..running.execution import Listener, Progress

FIFTY = 50
"""Characters of the bar on a terminal."""


def progress_bar(name: str = "run") -> Listener:
    """A listener for ``mpmkit.run`` that shows the progress of a run, in a notebook or on a terminal.

    >>> mpmkit.run(case, listen=mpmkit.progress_bar())

    Args:
        name: text beside the bar.
    """
    return _Notebook(name) if _in_notebook() else _Terminal(name)


def _in_notebook() -> bool:
    """Whether the code runs in a notebook; IPython in a terminal does not count as one."""
    ipython = sys.modules.get("IPython")  # a notebook always loads it
    shell = None if ipython is None else ipython.get_ipython()
    return type(shell).__name__ == "ZMQInteractiveShell"


def _words(progress: Progress) -> str:
    return f"t = {progress.time:.4g} of {progress.until:g} s, {progress.seconds_left:.0f} s left"


class _Notebook:
    def __init__(self, name: str) -> None:
        self._name = escape(name)
        self._handle: Any = None

    def __call__(self, progress: Progress) -> None:
        from IPython.display import HTML, display

        done = progress.time / progress.until
        bar = f'<progress max="1" value="{done:.4f}"></progress>'
        shown = HTML(f"<div>{self._name} {bar} {100 * done:.0f} %, {_words(progress)}</div>")
        if self._handle is None:
            self._handle = display(shown, display_id=True)
        else:
            self._handle.update(shown)


class _Terminal:
    def __init__(self, name: str) -> None:
        self._name = name

    def __call__(self, progress: Progress) -> None:
        if not sys.stderr.isatty():
            return
        done = min(1.0, progress.time / progress.until)
        bar = "━" * round(FIFTY * done)
        end = "\n" if done == 1.0 else ""
        sys.stderr.write(f"\r{self._name} {bar:{FIFTY}} {100 * done:3.0f} %  {_words(progress)}\x1b[K{end}")
        sys.stderr.flush()
