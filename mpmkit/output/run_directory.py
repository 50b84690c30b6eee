"""The directory of a run: where each of its files lies, and when it may be overwritten."""

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
"""What a killed process may have left."""
PICTURES = ("outline", "spread_and_height", "energies", "wall_forces")
"""Names of the pictures of a report, without their ending."""
MOVIE = "movie.gif"
"""The movie that ``mpmkit movie`` writes beside the pictures."""
PAGE = "index.html"
"""The page of a report."""
MESHES = "meshes"
"""Directory of the meshes that the case names; there is none if it names none."""


class RunDirectory:
    """The files of one run.

    Args:
        path: the directory; a leading ``~`` is the home folder.
        overwrite: whether ``claim`` may clear what an earlier run left there.
        keep: names of copies of meshes that it leaves in any case: the run may have been read from them.
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
        """What the page of the report plays."""
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
        """Claim the directory, and keep every other run out of it inside the block.

        With ``resume`` what is in it is of the same run, and stays.

        Raises:
            CaseError: where something is there that must not be overwritten.
            OutputError: where another run is at work, or the directory cannot be made or cleared.
        """
        if not resume:
            self._make()  # what is refused anyway is refused before a lock is put into it
        with alone_in(self.path, "run"):
            if not resume:
                self.claim()
            yield

    def claim(self) -> None:
        """Make the directory, or clear it of an earlier run.

        Raises:
            CaseError: where something is there that must not be overwritten.
            OutputError: where the directory cannot be made or cleared.
        """
        if self._make():
            try:
                self._clear()
            except OSError as error:
                raise cannot_write(self.path, error) from error

    def _make(self) -> bool:
        """Make the directory if it is not there; returns whether there is something to clear in it."""
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
        # A case file of the user's may well be called case.json: only beside results is it the run's own.
        if not (self.case.is_file() and any(path.exists() for path in self._results)):
            raise CaseError(
                f"the directory '{self.path}' is not empty and does not look like that of a run, so that "
                "--overwrite leaves it alone: choose another one with --out DIR"
            )

    @property
    def _results(self) -> tuple[Path, ...]:
        return self.history, self.summary, self.flow, self.frames, self.report, self.checkpoints, self.log

    def _clear(self) -> None:
        """Delete the files that a run writes and nothing else; case and log last, by which a run is known."""
        written = [self.history, self.summary, self.flow, *self.path.glob(PARTIAL)]
        pictures = [self.page, self.movie, *(self.report / f"{name}.png" for name in PICTURES)]
        frames = [*frame_files(self.frames), self.frames / LIST_NAME, self.frames / WALL_LIST]
        folders = [(self.frames, frames), (self.report, pictures)]
        if not self.frames.is_symlink():  # else it is the link that goes
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
            with suppress(OSError):  # it is not there, or something of the user's is in it
                directory.rmdir()
