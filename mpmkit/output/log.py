"""The log of a run: the messages of the logger ``mpmkit``, with time stamps."""

from __future__ import annotations

import logging
from contextlib import suppress
from contextvars import ContextVar
from pathlib import Path
from types import TracebackType

from .atomic import cannot_write

LOGGER = logging.getLogger("mpmkit")
RECORD = logging.getLogger("mpmkit.record")
"""Marks messages for ``run.log`` only; a display leaves them out."""
_OPEN: list[RunLog] = []
"""Logs of all runs of this process."""
_CURRENT: ContextVar[RunLog | None] = ContextVar("run_log", default=None)
"""Log of the run in this thread."""
_LEVEL_BEFORE = [logging.NOTSET]
"""Level of the logger before the first of them."""


class RunLog(logging.FileHandler):
    """A handler of the logger ``mpmkit`` until it is closed; also a context manager.

    It records only messages of the thread that opened it, and not those of runs in other threads.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(path, encoding="utf-8")
        self.setFormatter(logging.Formatter("%(asctime)s %(levelname)-7s %(message)s"))
        self._outer = _CURRENT.get()
        _CURRENT.set(self)
        self.addFilter(lambda record: _CURRENT.get() is self)
        if not _OPEN:
            _LEVEL_BEFORE[0] = LOGGER.level
        _OPEN.append(self)
        if not LOGGER.isEnabledFor(logging.INFO):
            LOGGER.setLevel(logging.INFO)
        LOGGER.addHandler(self)

    def handleError(self, record: logging.LogRecord) -> None:
        """Ignore the error: a run must not end because of its log; a full disk stops the history anyway."""

    def close(self) -> None:
        if self in LOGGER.handlers:  # closed by the run, and again by logging at exit
            LOGGER.removeHandler(self)
            _OPEN.remove(self)
            if not _OPEN:
                LOGGER.setLevel(_LEVEL_BEFORE[0])
            if _CURRENT.get() is self:
                _CURRENT.set(self._outer)
        with suppress(OSError):  # the last lines may not fit on the disk
            super().close()

    def __enter__(self) -> RunLog:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()


def open_log(path: Path) -> RunLog:
    """Start to log to a file; messages are appended.

    Raises:
        OutputError: the file cannot be opened.
    """
    try:
        return RunLog(Path(path))
    except OSError as error:
        raise cannot_write(Path(path), error) from error
