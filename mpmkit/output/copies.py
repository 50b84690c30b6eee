"""Copies of the files that a case names; each is named by its content."""

from __future__ import annotations

from collections.abc import Container, Mapping
from contextlib import suppress
from pathlib import Path

from ..errors import CaseError, reason
from .atomic import replacing
from .content_names import is_name_by_content, name_by_content


class Copies:
    """The copies in one run directory."""

    def __init__(self, directory: Path) -> None:
        self.directory = Path(directory)

    def write(self, contents: Mapping[str, bytes]) -> None:
        """Add files, by their names.

        Raises:
            OutputError: where one cannot be written.
        """
        for name, content in contents.items():
            with replacing(self.directory / name) as partial:
                self.directory.mkdir(exist_ok=True)
                partial.write_bytes(content)

    def check(self) -> None:
        """Check that the content of each copy still agrees with its name.

        Raises:
            CaseError: it does not agree, or cannot be read.
        """
        for path in self.paths():
            try:
                content = path.read_bytes()
            except OSError as error:
                raise CaseError(f"the file '{path}' of the run cannot be read: {reason(error)}") from None
            if name_by_content(content, path.suffix) != path.name:
                raise CaseError(f"the file '{path}' is not what the run began with: its content has changed")

    def paths(self) -> list[Path]:
        """The copies; other files in the directory belong to the user."""
        return [path for path in sorted(self.directory.glob("*")) if is_name_by_content(path.name)]

    def remove(self, but: Container[str] = ()) -> None:
        """Remove the copies except some names, and the directory if it is then empty.

        Raises:
            OSError: one cannot be removed.
        """
        if self.directory.is_symlink():  # its target belongs to the user
            self.directory.unlink()
            return
        stale = [path for path in self.paths() if path.name not in but]
        for path in (*stale, *self.directory.glob(".*.partial")):
            path.unlink()
        with suppress(OSError):
            self.directory.rmdir()
