"""Atomic writing: a file is either the old or the new one, even if the process dies."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import OutputError


def cannot_write(path: Path, error: Exception) -> OutputError:
    """The one sentence for a path that could not be written, made, or cleared."""
    reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
    return OutputError(f"cannot write '{path}': {reason}")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a path to write to; its file replaces ``path`` if the block ends without error.

    Raises:
        OutputError: the block, or the replacement, failed with an ``OSError``.
    """
    partial = path.with_name(
        f".{path.name}.partial"
    )  # in the same directory, so that replacing is one rename
    try:
        yield partial
        os.replace(partial, path)
    except OSError as error:
        raise cannot_write(path, error) from error
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
