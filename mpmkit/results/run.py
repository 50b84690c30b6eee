"""One finished run: its case, its figures, its history, its frames."""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..case import Case, load_case
from ..case.state_variables import particle_variables
from ..errors import CaseError
from ..output import RunDirectory, read_frames
from ..output.near_runs import why_no_run
from ..output.netcdf import read_dataset
from .frames import open_frames
from .html import run_html

if TYPE_CHECKING:
    import xarray


class Run:
    """A run in its directory. Files are read when they are needed. A notebook shows its results and pictures.

    >>> run = mpmkit.open_run("runs/slump")
    >>> run.summary["t500"]
    >>> run.history.spread_diameter.plot()
    >>> run.frames.speed.isel(time=-1).max()
    """

    def __init__(self, directory: str | Path) -> None:
        self.directory = RunDirectory(Path(directory)).path

    def __repr__(self) -> str:
        return f"<Run of the case '{self.case.name}' in '{self.directory}'>"

    def _repr_html_(self) -> str:
        return run_html(self.directory, self.case.name, self.summary)

    @cached_property
    def case(self) -> Case:
        """The case, with all default values filled in."""
        return load_case(RunDirectory(self.directory).case)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The figures of ``summary.json``, in SI units."""
        return json.loads(RunDirectory(self.directory).summary.read_text(encoding="utf-8"))

    @cached_property
    def history(self) -> xarray.Dataset:
        """The history, in memory."""
        return read_dataset(RunDirectory(self.directory).history)

    @cached_property
    def frames(self) -> xarray.Dataset:
        """The frames, with the dimensions time and particle; a file is read when its values are needed.

        Raises:
            CaseError: there are none.
        """
        files = read_frames(RunDirectory(self.directory).frames)
        return open_frames(files, self.case.space_, particle_variables(self.case))


def open_run(directory: str | Path) -> Run:
    """Open the directory of a run that has ended.

    Args:
        directory: such as ``runs/slump``.

    Raises:
        CaseError: it does not hold the results of a run.
    """
    run = Run(directory)
    files = RunDirectory(run.directory)
    for path in (files.case, files.history, files.summary):
        if not path.is_file():
            raise CaseError(f"'{directory}' does not hold the results of a run: {why_no_run(run.directory)}")
    return run
