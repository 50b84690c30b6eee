"""Paths as arguments of commands."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import click

from ..errors import CaseError


class UserPath(click.Path):
    """A path in which a leading ``~`` is the home folder, also if the shell does not replace it."""

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> Any:
        path = os.path.expanduser(value)
        if Path(path).parts[:1] and Path(path).parts[0].startswith("~"):  # ./~ is a folder called ~
            path = os.path.abspath(path)
        return super().convert(path, parameter, context)


PATH = UserPath()


def refuse_existing(path: Path, overwrite: bool) -> None:
    """Refuse to replace a file without ``--overwrite``.

    Raises:
        CaseError: there is something at the path, and ``overwrite`` is False.
    """
    if not overwrite and os.path.lexists(path):
        raise CaseError(f"'{path}' exists: give --overwrite to replace it, or write elsewhere with --out")
