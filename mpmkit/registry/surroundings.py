"""Settings of the process that a plug-in changes are restored after each of its calls.

Otherwise results could go to another directory, NumPy could raise an error if a law of another plug-in
divides by zero, and warnings of a run could be lost.
"""

from __future__ import annotations

import logging
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

Settings = tuple[str | None, Any]
"""The working directory, None if it was removed, and the error handling of NumPy."""


def settings() -> Settings:
    """The present settings; they are read in every step of a run, in two microseconds."""
    return _working_directory(), np.geterr()


def restore(before: Settings) -> None:
    """Restore the settings that have changed."""
    directory, errors = before
    if directory is not None and _working_directory() != directory:
        os.chdir(directory)
    if np.geterr() != errors:
        np.seterr(**errors)


@contextmanager
def settings_and_log_kept() -> Iterator[None]:
    """Restore the settings, the filters of warnings and the levels of the log after the block."""
    before = settings()
    manager = logging.root.manager
    disabled = manager.disable
    ours = {
        logger: (logger.disabled, logger.level, logger.propagate)
        for name, logger in manager.loggerDict.items()
        if isinstance(logger, logging.Logger) and name.partition(".")[0] == "mpmkit"
    }
    with warnings.catch_warnings():
        try:
            yield
        finally:
            restore(before)
            logging.disable(disabled)
            for logger, (off, level, propagate) in ours.items():
                logger.disabled, logger.propagate = off, propagate
                logger.setLevel(level)


def _working_directory() -> str | None:
    try:
        return os.getcwd()
    except OSError:  # someone has removed it
        return None
