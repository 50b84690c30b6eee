"""The server process, which starts before the run and ends with it."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

LINGER = 5.0
"""Seconds that a browser has to load the last page after the end of the run."""


class Watch:
    """A context manager that serves the page of a run directory.

    Args:
        directory: of the run.
        resumed: whether the files that are in the directory now belong to this run.
        tell: called from another thread with the address, as soon as it is known.
    """

    def __init__(self, directory: Path, resumed: bool, tell: Callable[[str], None]) -> None:
        self._command = [sys.executable, "-m", "mpmkit.watch", str(directory)]
        self._command += ["--resumed"] if resumed else []
        self._tell = tell
        self._process: subprocess.Popen[str] | None = None

    def __enter__(self) -> Watch:
        # A separate process group: Ctrl-C goes to the run only, which then ends this process. Not a separate
        # session: Linux would then give it as much processor time as the run, whatever its priority.
        self._process = subprocess.Popen(
            self._command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            process_group=0 if os.name == "posix" else None,
        )
        threading.Thread(target=self._pass_on, args=(self._process,), daemon=True).start()
        return self

    def _pass_on(self, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        with suppress(OSError, ValueError):  # the run may have ended before
            for line in process.stdout:
                self._tell(line.strip())

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        process = self._process
        assert process is not None
        assert process.stdin is not None
        with suppress(OSError):
            process.stdin.close()  # this tells the server that the run has ended
        try:
            if kind is None:
                with suppress(subprocess.TimeoutExpired):
                    process.wait(LINGER)
        finally:
            process.kill()
            process.wait()
