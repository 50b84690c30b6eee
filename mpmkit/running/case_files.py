"""The files that a case names: what they hold, and the case that names copies of them instead."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..case.model import Case
from ..case.overrides import assign
from ..case.resolved import resolved
from ..errors import CaseError
from ..geometry import Shape
from ..output.content_names import name_by_content
from ..output.run_directory import MESHES


@dataclass(frozen=True)
class NamedFile:
    """A file that a case names."""

    body: int
    """number of the body whose shape names it"""
    shape: Shape
    field: str
    """of the shape"""
    name: str
    """of its copy, made from what it holds"""

    @property
    def where(self) -> str:
        """Place in the case, such as ``bodies.0.shape.file``."""
        return f"bodies.{self.body}.shape.{self.field}"

    @property
    def path(self) -> Path:
        return Path(getattr(self.shape, self.field)).absolute()

    def content(self) -> bytes:
        """What its copy holds.

        Raises:
            CaseError: the file cannot be read, or no longer holds what it did.
        """
        content = self.shape.content(self.field)
        if name_by_content(content, Path(self.name).suffix) != self.name:
            raise CaseError(f"{self.where} is {self.path}, but it was changed while it was being read")
        return content


def named_files(case: Case) -> list[NamedFile]:
    """All of them, in the order of the bodies.

    Raises:
        CaseError: one cannot be read.
    """
    return [
        NamedFile(number, body.shape, field, body.shape.content_name(field))
        for number, body in enumerate(case.bodies)
        for field in body.shape.files
    ]


def portable(case: Case) -> dict[str, Any]:
    """The resolved case as it stands in a run directory, which has copies of the files that it names.

    They are called by what they hold: where the originals lie makes no difference, what is in them does.

    Raises:
        CaseError: a file cannot be read.
    """
    data = resolved(case)
    for file in named_files(case):
        assign(data, file.where, f"{MESHES}/{file.name}")
    return data


def from_copies(case: Case, files: list[NamedFile], directory: Path) -> Case:
    """The case that names, instead of ``files``, their copies in a directory; its numbers are the same."""
    bodies = list(case.bodies)
    for file in files:
        shape = bodies[file.body].shape.model_copy(update={file.field: str(directory.absolute() / file.name)})
        bodies[file.body] = bodies[file.body].model_copy(update={"shape": shape})
    return case.model_copy(update={"bodies": bodies})
