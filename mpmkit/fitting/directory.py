"""The directory of a fit: its input, every run, and the result."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import CaseError
from ..output import write_json
from ..output.atomic import cannot_write
from ..output.lock import LOCK_NAME, alone_in
from ..output.netcdf import write_dataset
from ..study.store import Store
from .model import Fit
from .result import FitResult

PAGE = "fit.html"


class FitDirectory:
    """``asked.json``, ``fit.json``, ``runs.nc``, ``fit.html``, figures, and ``members/`` with every run.

    Args:
        path: the directory; a leading ``~`` is the home folder.
        overwrite: whether the result of another fit there may be replaced; its runs are kept in any case.
    """

    def __init__(self, path: Path, overwrite: bool = False) -> None:
        self.path = Path(os.path.expanduser(path))
        self.store = Store(self.path)
        self._asked, self._overwrite = self.path / "asked.json", overwrite

    @contextmanager
    def claimed(self, fit: Fit) -> Iterator[None]:
        """Lock the directory against other fits inside the block.

        Raises:
            CaseError: the directory contains files that must not be replaced.
            OutputError: it cannot be written, or another fit is running there.
        """
        try:
            filled = self.path.exists() and any(path.name != LOCK_NAME for path in self.path.iterdir())
            if filled and not self._asked.exists():
                raise CaseError(f"'{self.path}' exists and holds no fit; choose another with --out")
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(self.path, error) from error
        with alone_in(self.path, "fit"):
            asked = fit.model_dump(mode="json")
            if (self.path / "fit.json").exists() and self._before() != asked and not self._overwrite:
                raise CaseError(
                    f"'{self.path}' holds the result of another fit: give --overwrite to replace it (its "
                    "runs are kept), or --out DIR to write elsewhere"
                )
            write_json(self._asked, asked)
            yield

    def _before(self) -> object:
        try:
            return json.loads(self._asked.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None

    def write(self, result: FitResult) -> None:
        """Write the result, figures and page included; ``fit.json`` is written last."""
        from .figures import draw
        from .page import write_page

        write_dataset(result.dataset, self.path / "runs.nc")
        write_page(result, draw(result, self.path), self.path / PAGE)
        write_json(self.path / "fit.json", result.as_json())
