"""The directory of a run: where each of its files lies, and when it may be overwritten."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

from ..errors import CaseError
from .atomic import cannot_write
from .json_file import write_json


class RunDirectory:
    """The files of one run.

    Args:
        path: the directory.
        overwrite: whether ``claim`` may clear what an earlier run left there.
    """

    def __init__(self, path: Path, overwrite: bool = False) -> None:
        self.path = Path(path)
        self.overwrite = overwrite

    @property
    def case(self) -> Path:
        """The resolved case."""
        return self.path / "case.json"

    @property
    def history(self) -> Path:
        return self.path / "history.nc"

    @property
    def summary(self) -> Path:
        return self.path / "summary.json"

    @property
    def frames(self) -> Path:
        return self.path / "frames"

    @property
    def report(self) -> Path:
        return self.path / "report"

    @property
    def log(self) -> Path:
        return self.path / "run.log"

    def claim(self) -> None:
        """Make the directory, or clear it of an earlier run.

        Raises:
            CaseError: where something is there that must not be overwritten.
            OutputError: where the directory cannot be made or cleared.
        """
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            if any(self.path.iterdir()):
                self._refuse_if_precious()
                self._clear()
        except OSError as error:
            raise cannot_write(self.path, error) from error

    def write_json(self, path: Path, data: Any) -> None:
        """Write a JSON file of the run, with null for NaN; see ``json_file.write_json``."""
        write_json(path, data)

    def _refuse_if_precious(self) -> None:
        if not self.overwrite:
            raise CaseError(
                f"the directory '{self.path}' is not empty: "
                "give --overwrite to replace the run in it, or --out DIR to write elsewhere"
            )
        # A case file of the user's may well be called case.json: only beside results is it the run's own.
        if not (self.case.is_file() and any(path.exists() for path in self._results)):
            raise CaseError(
                f"the directory '{self.path}' is not empty and does not look like that of a run, so that "
                "--overwrite leaves it alone: choose another one with --out DIR"
            )

    @property
    def _results(self) -> tuple[Path, ...]:
        return self.history, self.summary, self.frames, self.report, self.log

    def _clear(self) -> None:
        """Delete what a run writes and nothing else; case and log last, by which a run is known."""
        for path in (*self.path.glob(".*.partial"), *self._results[:-1], self.case, self.log):
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)
