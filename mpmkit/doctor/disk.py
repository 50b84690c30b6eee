"""Room on the disks that a run writes to."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

from .finding import Finding, mebibytes

LITTLE = 2**30
"""Bytes; about the size of the frames of a three-dimensional run."""


def disk() -> Finding:
    """Free room in the working directory, where ``runs/`` is written, and for temporary files."""
    found = Finding()
    for what, folder in (("working directory", Path.cwd()), ("temporary files", Path(tempfile.gettempdir()))):
        free = shutil.disk_usage(folder).free
        found.facts[what] = f"{folder}, {mebibytes(free)} free"
        if free < LITTLE:
            found.problems.append(f"only {mebibytes(free)} are free on the disk of '{folder}'")
    if not os.access(Path.cwd(), os.W_OK):
        found.problems.append(
            f"the working directory '{Path.cwd()}' cannot be written: choose another directory with --out DIR"
        )
    return found
