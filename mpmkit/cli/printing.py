"""Output of commands: only results go to the standard output."""

from __future__ import annotations

import ctypes
import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, TextIO

import click

STDOUT, STDERR = 1, 2
"""File descriptors of the standard output and the standard error."""
_results: TextIO | None = None
"""The stream for results while a command runs; None for Python's standard output."""


def replace_unknown_characters() -> None:
    """Print a question mark for each character that the encoding of an output lacks, instead of an error."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)  # a stream in their place may lack it
        if reconfigure is not None:
            reconfigure(errors="replace")


@contextmanager
def results_alone() -> Iterator[None]:
    """Keep the standard output for ``echo``: other output inside the block goes to standard error.

    This holds for ``print``, for libraries in other languages, and for processes that are started.
    """
    global _results
    before = sys.stdout
    if before is not None:
        before.flush()
    saved = None
    with suppress(OSError):  # one of them is closed, or a test has replaced it
        saved = os.dup(STDOUT)
        os.dup2(STDERR, STDOUT)
    _results, sys.stdout = _opened(before, saved), sys.stderr
    try:
        yield
    finally:
        sys.stdout = before
        with suppress(OSError, ValueError):
            before.flush()  # other output, while the descriptor still leads to standard error
        if _results is not before and _results is not None:
            with suppress(OSError):  # ``echo`` has reported it
                _results.close()
        _results = None
        if saved is not None:
            with suppress(OSError, AttributeError, TypeError):  # other systems find the C library otherwise
                ctypes.CDLL(None).fflush(None)
            os.dup2(saved, STDOUT)
            os.close(saved)


def _opened(stream: TextIO, saved: int | None) -> TextIO:
    """A copy of a stream that keeps its present target; the stream itself if it is not this descriptor."""
    try:
        if saved is None or stream.fileno() != STDOUT:
            return stream
    except (OSError, AttributeError):  # there is none, or it has no file
        return stream
    return open(os.dup(saved), "w", encoding=stream.encoding, errors=stream.errors)


def echo(text: str, nl: bool = True) -> None:
    """Print a result on the standard output."""
    click.echo(text, file=_results, nl=nl)


def echo_json(data: Any) -> None:
    """Print JSON; characters beyond ASCII are escaped, except if the encoding is UTF-8."""
    encoding = getattr(_results or sys.stdout, "encoding", None) or "utf-8"
    readable = encoding.lower().replace("-", "").replace("_", "") == "utf8"
    echo(json.dumps(data, indent=2, ensure_ascii=not readable))
