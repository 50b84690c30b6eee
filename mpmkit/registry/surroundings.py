"""What a plug-in changes of the process that it shares with all others is undone when it has had its turn.

Otherwise results could go to another directory, NumPy could raise where a law of another plug-in divides by
zero, and warnings of a run could be lost.
"""

from __future__ import annotations

import logging
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import numpy as np


@contextmanager
def settings_kept() -> Iterator[None]:
    """The working directory and NumPy's treatment of errors are after the block what they were before."""
    before = _working_directory()
    try:
        with np.errstate():
            yield
    finally:
        if before is not None and _working_directory() != before:
            os.chdir(before)


@contextmanager
def settings_and_log_kept() -> Iterator[None]:
    """As ``settings_kept``, and so are the filters of warnings, and what the log of mpmkit lets through."""
    manager = logging.root.manager
    disabled = manager.disable
    ours = {
        logger: (logger.disabled, logger.level, logger.propagate)
        for name, logger in manager.loggerDict.items()
        if isinstance(logger, logging.Logger) and name.partition(".")[0] == "mpmkit"
    }
    with settings_kept(), warnings.catch_warnings():
        try:
            yield
        finally:
            logging.disable(disabled)
            for logger, (off, level, propagate) in ours.items():
                logger.disabled, logger.propagate = off, propagate
                logger.setLevel(level)


def _working_directory() -> str | None:
    with suppress(OSError):  # someone has removed it
        return os.getcwd()
    return None
