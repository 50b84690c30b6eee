"""Ahead-of-time compilation: other processes compile the functions that a run will need soon.

numba compiles one function at a time in a process. So this process starts some ``compile_ahead`` processes as
soon as a function is missing from the cache of compiled code, and gives them a list of what the run needs.
They write what they compile into the cache, and the run loads it from there. If such a process ends early,
the run compiles the rest itself; only time is lost.

Each process *claims* a function before it compiles it: it creates a file with the name of the code in a
common folder. A run that needs code that another process has claimed waits for it.
"""

from __future__ import annotations

import atexit
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from .needs import Need

NEEDS = "needs.json"
"""File in the folder of the claims: what is needed, in the order in which it should be compiled."""
PATIENCE = 0.01
"""Seconds between two checks of a claim."""


class Ahead:
    """The processes that compile ahead of this one."""

    def __init__(self) -> None:
        self._needs: list[Need] = []
        self._count = 0
        self._folder: tempfile.TemporaryDirectory | None = None
        self._processes: list[subprocess.Popen] = []
        self._own: set[Path] = set()

    def expect(self, needs: Sequence[Need], processes: int) -> None:
        """Set what this process will need, in the order in which it should be compiled.

        No process is started until a function is missing from the cache.
        """
        self._needs, self._count = list(needs) if processes else [], processes

    def compiles(self, code: Path) -> bool:
        """Wait for another process to compile this code; False if this process must compile it.

        The first call starts the processes.
        """
        if self._needs:
            self._begin()
        if self._folder is None or code in self._own:
            return False
        folder = Path(self._folder.name)
        if claim(folder, code):
            self._own.add(code)
            return code.exists()  # it may have been written since the caller looked
        while claim_of(folder, code).exists() and any(process.poll() is None for process in self._processes):
            time.sleep(PATIENCE)
        return code.exists()

    def _begin(self) -> None:
        needs, self._needs = self._needs, []
        self._folder = tempfile.TemporaryDirectory(prefix="mpmkit-ahead-", ignore_cleanup_errors=True)
        atexit.register(self.end)
        listed = json.dumps([need.as_dict() for need in needs])
        (Path(self._folder.name) / NEEDS).write_text(listed, encoding="utf-8")
        command = [sys.executable, "-P", "-m", f"{__package__}.compile_ahead", self._folder.name]
        for _ in range(self._count):
            with suppress(OSError):
                # The pipe closes when this process ends, however it ends; then the other process ends too.
                process = subprocess.Popen(
                    command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
                )
                self._processes.append(process)

    def end(self) -> None:
        """End the processes, also in the middle of their work."""
        for process in self._processes:
            process.kill()
            process.wait()
            assert process.stdin is not None
            with suppress(OSError):
                process.stdin.close()
        self._processes.clear()
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None


def claim_of(folder: Path, code: Path) -> Path:
    """The file whose presence says that a process is compiling this code."""
    return folder / code.name


def claim(folder: Path, code: Path) -> bool:
    """Claim code for this process; False if another one has claimed it."""
    try:
        os.close(os.open(claim_of(folder, code), os.O_CREAT | os.O_EXCL))
    except OSError:
        return False
    return True


AHEAD = Ahead()
"""The processes that compile ahead of this process."""
