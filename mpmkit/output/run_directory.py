"""The directory of a run: the paths of its files, and the rules for overwriting."""

from __future__ import annotations

import os
from collections.abc import Container, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import CaseError
from .atomic import cannot_write
from .checkpoints import Checkpoints
from .copies import Copies
from .frames import LIST_NAME, frame_files
from .lock import LOCK_NAME, alone_in
from .wall_frames import FOLDER as WALLS
from .wall_frames import LIST_NAME as WALL_LIST
from .wall_frames import wall_frame_files

PARTIAL = ".*.partial"
"""Files that a killed process may have left."""
PICTURES = ("outline", "spread_and_height", "energies", "wall_forces")
"""Names of the pictures of a report, without their extension."""
MOVIE = "movie.gif"
"""The movie of ``mpmkit movie``, in the folder of the pictures."""
PAGE = "index.html"
"""The page of a report."""
MESHES = "meshes"
"""Directory of the meshes of the case; missing if it has none."""


class RunDirectory:
    """The files of one run.

    Args:
        path: the directory; a leading ``~`` is the home folder.
        overwrite: whether ``claim`` may delete the files of an earlier run there.
        keep: names of copies of meshes that are never deleted: the case may have been read from them.
    """

    def __init__(self, path: Path, overwrite: bool = False, keep: Container[str] = ()) -> None:
        self.path = Path(os.path.expanduser(path))
        self.overwrite = overwrite
        self._keep = keep

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
    def flow(self) -> Path:
        """The data for the player of the page."""
        return self.path / "flow.npz"

    @property
    def page(self) -> Path:
        """The page of the report."""
        return self.report / PAGE

    @property
    def report(self) -> Path:
        return self.path / "report"

    @property
    def movie(self) -> Path:
        return self.report / MOVIE

    @property
    def checkpoints(self) -> Path:
        return self.path / "checkpoints"

    @property
    def meshes(self) -> Path:
        return self.path / MESHES

    @property
    def log(self) -> Path:
        return self.path / "run.log"

    @contextmanager
    def claimed(self, resume: bool = False) -> Iterator[None]:
        """Claim the directory, and lock it against other runs inside the block.

        With ``resume``, the files in it belong to the same run and are kept.

        Raises:
            CaseError: the directory contains files that must not be overwritten.
            OutputError: another run is running there, or the directory cannot be made or cleared.
        """
        if not resume:
            self._make()  # refuse an unsuitable directory before a lock file is made in it
        with alone_in(self.path, "run"):
            if not resume:
                self.claim()
            yield

    def claim(self) -> None:
        """Make the directory, or clear it of an earlier run.

        Raises:
            CaseError: the directory contains files that must not be overwritten.
            OutputError: the directory cannot be made or cleared.
        """
        if self._make():
            try:
                self._clear()
            except OSError as error:
                raise cannot_write(self.path, error) from error

    def _make(self) -> bool:
        """Make the directory if it is missing; return whether it contains files to delete."""
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            filled = any(path.name != LOCK_NAME for path in self.path.iterdir())
        except OSError as error:
            raise cannot_write(self.path, error) from error
        if filled:
            self._refuse_if_precious()
        return filled

    def _refuse_if_precious(self) -> None:
        if not self.overwrite:
            raise CaseError(
                f"the directory '{self.path}' is not empty: "
                "give --overwrite to replace the run in it, or --out DIR to write elsewhere"
            )
        # A case file of the user may also be called case.json: only with results, it belongs to a run.
        if not (self.case.is_file() and any(path.exists() for path in self._results)):
            raise CaseError(
                f"the directory '{self.path}' is not empty and does not look like that of a run, so that "
                "--overwrite does not change it: choose another one with --out DIR"
            )

    @property
    def _results(self) -> tuple[Path, ...]:
        return self.history, self.summary, self.flow, self.frames, self.report, self.checkpoints, self.log

    def _clear(self) -> None:
        """Delete only the files that a run writes; case and log last, because they identify a run."""
        written = [self.history, self.summary, self.flow, *self.path.glob(PARTIAL)]
        pictures = [self.page, self.movie, *(self.report / f"{name}.png" for name in PICTURES)]
        frames = [*frame_files(self.frames), self.frames / LIST_NAME, self.frames / WALL_LIST]
        folders = [(self.frames, frames), (self.report, pictures)]
        if not self.frames.is_symlink():  # a link itself is removed
            folders.insert(0, (self.frames / WALLS, wall_frame_files(self.frames)))
        for directory, files in folders:
            if directory.is_symlink():
                written.append(directory)
            else:
                written += [*files, *directory.glob(PARTIAL)]
        for path in (*written, self.case, self.log):
            path.unlink(missing_ok=True)
        Checkpoints(self.checkpoints).remove()
        Copies(self.meshes).remove(but=self._keep)
        for directory, _ in folders:
            with suppress(OSError):  # it is missing, or contains files of the user
                directory.rmdir()
