"""Frames of walls: their surfaces at the times of the frames, in VTU files, and a PVD that lists them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..spaces import Space
from .atomic import cannot_write, replacing
from .frames import read_vtu
from .pvd import Entry, read_pvd, write_pvd

LIST_NAME = "walls.pvd"
FOLDER = "walls"
NOTHING = f"{FOLDER}/nothing.vtu"
"""File of a wall that does not exist at a time; otherwise a viewer would show its last position."""
EMPTY = """<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1">
<UnstructuredGrid>
<Piece NumberOfPoints="0" NumberOfCells="0">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii"></DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii"></DataArray>
<DataArray type="Int64" Name="offsets" format="ascii"></DataArray>
<DataArray type="UInt8" Name="types" format="ascii"></DataArray>
</Cells>
</Piece>
</UnstructuredGrid>
</VTKFile>
"""
_NAME = re.compile(r"nothing\.vtu|[A-Za-z0-9_-]+_\d{6,}\.vtu")
CELLS = {2: "line", 3: "triangle"}
"""Cell types of a drawn surface, by the number of dimensions."""


class Drawn(NamedTuple):
    """A drawn surface: segments in two dimensions, triangles in three."""

    points: np.ndarray
    """m, (p, dim)"""
    parts: np.ndarray
    """the points of each segment or triangle, (s, dim)"""
    velocity: np.ndarray
    """of the wall at its points, m/s, (p, dim)"""


class WallFrameWriter:
    """Writes the walls of a run into ``frames/walls/``, and their list into the folder of the list of frames.

    Args:
        directory: the ``frames/`` of a run; it must exist.
        space: of the scene.
        names: of the walls, of which each is a part of the list.
        goes_on: whether files of the run to be continued exist; ``restore`` selects those to keep.
    """

    def __init__(self, directory: Path, space: Space, names: Sequence[str], goes_on: bool = False) -> None:
        self.directory = Path(directory)
        self._dim = space.dim
        self._names = tuple(names)
        self._entries: list[Entry] = []
        if not goes_on:
            self._remove_others()

    def state(self) -> dict[str, np.ndarray]:
        """Times, files and walls of the entries."""
        return {
            "times": np.array([entry.time for entry in self._entries]),
            "files": np.array([entry.file for entry in self._entries], dtype=str),
            "parts": np.array([entry.part for entry in self._entries], dtype=np.int64),
        }

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Continue after these; all others are removed.

        Raises:
            OutputError: where one cannot be removed, or the list cannot be written.
        """
        self._entries = [
            Entry(float(time), str(file), int(part), self._names[part])
            for time, file, part in zip(state["times"], state["files"], state["parts"], strict=True)
        ]
        self._remove_others()
        if self._names:
            self._write_list()

    def _remove_others(self) -> None:
        kept = {Path(entry.file).name for entry in self._entries}
        try:
            # Remove the list first: a list without its files would be worse than files without a list.
            (self.directory / LIST_NAME).unlink(missing_ok=True)
            for old in wall_frame_files(self.directory):
                if old.name not in kept:
                    old.unlink()
            if self._names:
                (self.directory / FOLDER).mkdir(exist_ok=True)
        except OSError as error:
            raise cannot_write(self.directory / FOLDER, error) from error

    def write(self, time: float, step: int, walls: Mapping[str, Drawn | None]) -> None:
        """Write the walls at a time, and add them to the list.

        Args:
            time: simulated time, s.
            step: number of the step, which names the files.
            walls: every wall by name; None for a wall that has not changed, whose last file is listed again.

        Raises:
            OutputError: where something cannot be written.
        """
        last = {entry.name: entry.file for entry in self._entries}
        self._entries = [entry for entry in self._entries if entry.time != time]
        for part, name in enumerate(self._names):
            drawn = walls[name]
            file = last[name] if drawn is None else f"{FOLDER}/{name}_{step:06d}.vtu"
            if drawn is not None and not len(drawn.parts):
                file = self._nothing()
            elif drawn is not None:
                self._write(self.directory / file, drawn)
            self._entries.append(Entry(float(time), file, part, name))
        self._write_list()

    def _write(self, path: Path, drawn: Drawn) -> None:
        import meshio

        points, velocity = (np.pad(v, ((0, 0), (0, 3 - self._dim))) for v in (drawn.points, drawn.velocity))
        mesh = meshio.Mesh(points, [(CELLS[self._dim], drawn.parts)], point_data={"velocity": velocity})
        with replacing(path) as partial:
            meshio.write(partial, mesh, file_format="vtu", binary=True)

    def _nothing(self) -> str:
        """Write the file of a wall that does not exist; meshio cannot read a file without cells."""
        with replacing(self.directory / NOTHING) as partial:
            partial.write_text(EMPTY, encoding="utf-8")
        return NOTHING

    def _write_list(self) -> None:
        # Files may have been deleted: ParaView cannot open a list with missing files.
        there = [entry for entry in self._entries if (self.directory / entry.file).is_file()]
        write_pvd(self.directory / LIST_NAME, there)


def wall_frame_files(directory: Path) -> list[Path]:
    """The files of walls of runs in a ``frames/``; other files in it belong to the user."""
    return [path for path in (Path(directory) / FOLDER).glob("*.vtu") if _NAME.fullmatch(path.name)]


def read_wall_frames(directory: Path) -> dict[float, dict[str, Path]]:
    """Files of the existing walls, by time, s, and name; empty if there is no list.

    Raises:
        CaseError: where the list is not one.
    """
    found: dict[float, dict[str, Path]] = {}
    for entry in read_pvd(Path(directory) / LIST_NAME):
        walls = found.setdefault(entry.time, {})
        if entry.file != NOTHING:
            walls[entry.name] = Path(directory) / entry.file
    return found


def read_wall_frame(path: Path) -> Drawn:
    """A wall from a file; its vectors have three components.

    Raises:
        CaseError: it cannot be read.
    """
    mesh = read_vtu(path)
    return Drawn(mesh.points, mesh.cells[0].data, mesh.point_data["velocity"])
