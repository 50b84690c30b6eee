"""A tiny case to vary, and executors without processes."""

import copy
import os
import signal
import tempfile
import time
from concurrent.futures import Executor, Future
from pathlib import Path

from test_cli import CASE, one_line, status

from mpmkit.study import parse_study
from mpmkit.study.work import Outcome

__all__ = ["CASE", "DEADLY", "LEAVES", "NOTHING", "Now", "fragile", "one_line", "patient", "status", "study"]

LEAVES = {"grid.faces.x_max": "open", "bodies.0.velocity": [200, 0]}
"""Changes with which the material leaves through an open face."""
NOTHING = {"bodies.0.shape.upper": [0.201, 0.001]}
"""Changes that are a valid case, of a body without a particle."""
DEADLY = 6.66e-3
"""The ``until`` of which a ``fragile`` worker dies."""


def study(**keys):
    """A study of the tiny case, or of another."""
    return parse_study({"name": "tiny", "case": copy.deepcopy(CASE)} | keys)


class Now(Executor):
    """An executor that runs its work at once in this process, and records it."""

    def __init__(self):
        self.ran = []

    def submit(self, work, /, *arguments, **options):
        self.ran.append(arguments[0])
        future = Future()
        try:
            future.set_result(work(*arguments, **options))
        except Exception as error:
            future.set_exception(error)
        return future


def fragile(data, threads, page):
    """Instead of a run: does nothing, or ends the process."""
    if data["until"] == DEADLY:
        os.kill(os.getpid(), signal.SIGKILL)
    return Outcome("finished", "", {}, {"wall_seconds": 0.0}, b"")


def patient(data, threads, page):
    """In the place of a run: it begins, and ends once there is a file ``killed`` in $TMPDIR."""
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / "begun").touch()
        deadline = time.monotonic() + 120
        while not (Path(os.environ["TMPDIR"]) / "killed").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
    return Outcome("finished", "", {}, {"wall_seconds": 0.0}, b"")
