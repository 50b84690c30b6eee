"""The files that a case names: their content, and the case with the paths of copies."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..case.model import Case, Wall
from ..case.overrides import assign
from ..case.resolved import resolved
from ..case.shapes import shapes_in
from ..contracts import BodyShape
from ..errors import CaseError
from ..output.content_names import name_by_content
from ..output.run_directory import MESHES


@dataclass(frozen=True)
class NamedFile:
    """A file that a case names."""

    at: str
    """path in the case of the shape that names it, such as ``bodies.0.shape``"""
    shape: BodyShape
    field: str
    """of the shape"""
    name: str
    """name of its copy, made from its content"""

    @property
    def where(self) -> str:
        """Path in the case, such as ``bodies.0.shape.file``."""
        return f"{self.at}.{self.field}"

    @property
    def path(self) -> Path:
        return Path(getattr(self.shape, self.field)).absolute()

    def content(self) -> bytes:
        """The content of its copy.

        Raises:
            CaseError: the file cannot be read, or its content has changed.
        """
        content = self.shape.content(self.field)
        if name_by_content(content, Path(self.name).suffix) != self.name:
            raise CaseError(f"{self.where} is {self.path}, but it was changed while it was being read")
        return content


def named_files(case: Case) -> list[NamedFile]:
    """All of them, in the order of the bodies and of the walls.

    Raises:
        CaseError: one cannot be read.
    """
    return [
        NamedFile(at, shape, field, shape.content_name(field))
        for at, shape in _shapes(case).items()
        for field in shape.files
    ]


def _shapes(case: Case) -> dict[str, BodyShape]:
    """The shapes of a case by their places in it: of bodies, and of surfaces that are made of one."""
    found: dict[str, BodyShape] = {
        f"bodies.{number}.shape": body.shape for number, body in enumerate(case.bodies)
    }
    for name, wall in case.walls.items():
        for field, shape in shapes_in(wall.surface).items():
            found[f"walls.{name}.surface.{field}"] = shape
    return found


def portable(case: Case) -> dict[str, Any]:
    """The resolved case for a run directory, which contains copies of the files that it names.

    Copies are named by their content: the place of the originals makes no difference, their content does.

    Raises:
        CaseError: a file cannot be read.
    """
    data = resolved(case)
    for file in named_files(case):
        assign(data, file.where, f"{MESHES}/{file.name}")
    return data


def from_copies(case: Case, files: list[NamedFile], directory: Path) -> Case:
    """The case with the paths of copies in a directory instead of ``files``; its numbers are the same."""
    shapes = _shapes(case)
    for file in files:
        copy = str(directory.absolute() / file.name)
        shapes[file.at] = shapes[file.at].model_copy(update={file.field: copy})
    bodies = [
        body.model_copy(update={"shape": shapes[f"bodies.{number}.shape"]})
        for number, body in enumerate(case.bodies)
    ]
    walls = {
        name: _with_shapes(
            wall, {field: shapes[f"walls.{name}.surface.{field}"] for field in shapes_in(wall.surface)}
        )
        for name, wall in case.walls.items()
    }
    return case.model_copy(update={"bodies": bodies, "walls": walls})


def _with_shapes(wall: Wall, shapes: dict[str, BodyShape]) -> Wall:
    """A wall whose surface is made of other shapes."""
    return wall.model_copy(update={"surface": wall.surface.model_copy(update=shapes)})
