"""What a plug-in changes of the process that it shares with all others is undone when it has had its turn.

Otherwise results could go to another directory, NumPy could raise where a law of another plug-in divides by
zero, and warnings of a run could be lost.
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
"""The working directory, None if it was removed, and how NumPy treats errors."""


def settings() -> Settings:
    """The present ones: taken in every step of a run, in two microseconds."""
    return _working_directory(), np.geterr()


def restore(before: Settings) -> None:
    """Set back what is no longer as it was."""
    directory, errors = before
    if directory is not None and _working_directory() != directory:
        os.chdir(directory)
    if np.geterr() != errors:
        np.seterr(**errors)


@contextmanager
def settings_and_log_kept() -> Iterator[None]:
    """After the block, the settings, filters of warnings, and what the log lets through are as they were."""
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
