"""Frames: the particles at a few times, one VTU file each, listed with their times in a PVD for ParaView."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import CaseError, reason
from ..spaces import Space
from .atomic import cannot_write, replacing
from .pvd import Entry, read_pvd, write_pvd

if TYPE_CHECKING:
    import meshio

LIST_NAME = "frames.pvd"
_NAME = re.compile(r"frame_\d{6,}\.vtu")


class FrameWriter:
    """Writes frames into a directory without old frames.

    Args:
        directory: the ``frames/`` of a run; made if it is not there.
        space: space of the scene; the vectors of a space with two axes (a, b) are written as (a, b, 0), so
            that a viewer shows the scene from the front when it opens.
        goes_on: whether the directory has frames of the run to be continued; ``restore`` selects those to
            keep.
    """

    def __init__(self, directory: Path, space: Space, goes_on: bool = False) -> None:
        self.directory = Path(directory)
        self._planar = space.dim == 2
        self.frames: dict[str, float] = {}
        """times, s, by the names of their files"""
        try:
            self.directory.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(self.directory, error) from error
        if not goes_on:
            self._remove_others()

    def state(self) -> dict[str, np.ndarray]:
        """Names of the files, and times."""
        return {
            "names": np.array(list(self.frames), dtype=str),
            "times": np.array(list(self.frames.values())),
        }

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Continue after these frames; all others in the directory are removed.

        Raises:
            OutputError: where one cannot be removed, or the list cannot be written.
        """
        self.frames = dict(zip(map(str, state["names"]), map(float, state["times"]), strict=True))
        self._remove_others()
        self._write_list()

    def _remove_others(self) -> None:
        """Remove the frames that are not of this run, and the list."""
        try:
            # Remove the list first: a list without its frames would be worse than frames without a list.
            for old in (self.directory / LIST_NAME, *frame_files(self.directory)):
                if old.name not in self.frames:
                    old.unlink(missing_ok=True)
        except OSError as error:
            raise cannot_write(self.directory, error) from error

    def write(self, time: float, step: int, fields: Mapping[str, np.ndarray], position: np.ndarray) -> Path:
        """Write the particles at a time, and add the frame to the list.

        Args:
            time: simulated time, s.
            step: number of the step, which names the file; a frame of the same step is replaced.
            fields: particle fields ``(n,)`` or ``(n, k)``; those ``(n, dim)`` are vectors.
            position: ``(n, dim)``, m.

        Raises:
            OutputError: where the frame or the list cannot be written.
        """
        import meshio

        vertices = [("vertex", np.arange(len(position))[:, None])]
        data = {name: self._in_space(np.asarray(field)) for name, field in fields.items()}
        mesh = meshio.Mesh(self._in_space(np.asarray(position)), vertices, point_data=data)
        path = self.directory / f"frame_{step:06d}.vtu"
        with replacing(path) as partial:
            meshio.write(partial, mesh, file_format="vtu", binary=True)
        self.frames[path.name] = float(time)
        self._write_list()
        return path

    def _in_space(self, values: np.ndarray) -> np.ndarray:
        if self._planar and values.ndim == 2 and values.shape[1] == 2:
            return np.insert(values, 2, 0, axis=1)
        return values

    def _write_list(self) -> None:
        # Frames may have been deleted: ParaView cannot open a list with missing files.
        self.frames = {name: t for name, t in self.frames.items() if (self.directory / name).is_file()}
        write_pvd(self.directory / LIST_NAME, (Entry(time, name) for name, time in self.frames.items()))


def frame_files(directory: Path) -> list[Path]:
    """The frames of runs in a directory; other files in it belong to the user."""
    return [path for path in Path(directory).glob("frame_*.vtu") if _NAME.fullmatch(path.name)]


def read_frames(directory: Path) -> list[tuple[float, Path]]:
    """Times, s, and files of the frames of a directory, in order of time; empty if there is no list.

    A frame that is listed but has been deleted is left out.

    Raises:
        CaseError: where the list is not one.
    """
    directory = Path(directory)
    return [(entry.time, directory / entry.file) for entry in read_pvd(directory / LIST_NAME)]


def read_frame(path: Path) -> dict[str, np.ndarray]:
    """The fields of a frame by name, ``(n,)`` or ``(n, k)``, and ``position``, ``(n, 3)``, m.

    Raises:
        CaseError: it cannot be read.
    """
    mesh = read_vtu(path)
    return {"position": mesh.points, **mesh.point_data}


def read_vtu(path: Path) -> meshio.Mesh:
    """The mesh in a file of a run.

    Raises:
        CaseError: it cannot be read.
    """
    from meshio.vtu import read  # meshio.read ends the process where a file is cut off

    try:
        return read(str(path))
    except Exception as error:
        raise CaseError(f"the frame '{path}' cannot be read: {reason(error)}") from None
