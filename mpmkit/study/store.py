"""The directory of a study: what its members gave, member by member, so that none is run twice."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

import xarray

from ..errors import CaseError
from ..output import write_json
from ..output.atomic import cannot_write, replacing
from ..output.lock import LOCK_NAME, alone_in
from .members import Member
from .model import Study
from .table import table
from .work import FAILED, Outcome


class Store:
    """``study.json``, ``results.nc``, ``table.md``, figures, and ``members/`` with a directory each."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.study = path / "study.json"
        self.results = path / "results.nc"

    @contextmanager
    def claimed(self, study: Study) -> Iterator[None]:
        """As ``open``, and keep every other study out of the directory inside the block.

        Raises:
            CaseError: there is something else in it.
            OutputError: it cannot be written, or another study is at work there.
        """
        self._make()
        with alone_in(self.path, "study"):
            self.open(study)
            yield

    def open(self, study: Study) -> None:
        """Make the directory, or go on in one that holds a study.

        Raises:
            CaseError: there is something else in it.
            OutputError: it cannot be written.
        """
        self._make()
        write_json(self.study, study.model_dump(mode="json"))

    def _make(self) -> None:
        try:
            filled = self.path.exists() and any(path.name != LOCK_NAME for path in self.path.iterdir())
            if filled and not self.study.exists():
                raise CaseError(f"'{self.path}' exists and holds no study; choose another with --out")
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(self.path, error) from error

    def directory(self, member: Member) -> Path:
        return self.path / "members" / member.slug

    def keep(self, member: Member, outcome: Outcome) -> None:
        """Write what became of a member; its ``member.json`` comes last, and says that it is complete."""
        directory = self.directory(member)
        try:
            directory.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(directory, error) from error
        with replacing(directory / "history.nc") as partial:
            partial.write_bytes(outcome.history)
        write_json(directory / "case.json", member.data)
        record = asdict(outcome)
        record.pop("history")
        write_json(directory / "member.json", {"labels": member.labels, "digest": member.digest, **record})

    def outcome(self, member: Member) -> dict[str, Any] | None:
        """What is kept of a member that ran, of this very case with these versions; None if none did."""
        try:
            record = json.loads((self.directory(member) / "member.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        return record if record.get("digest") == member.digest else None

    def settled(self, member: Member) -> bool:
        """Whether a member has come to an end that it would come to again: its own, or a guard's.

        What failed may have failed of the machine, or of something that was not installed.
        """
        record = self.outcome(member)
        return record is not None and record["fate"] != FAILED

    def write(self, dataset: xarray.Dataset) -> None:
        """Write everything there is, ``results.nc``, ``table.md`` and the figures."""
        from .figures import draw

        with replacing(self.results) as partial:
            dataset.to_netcdf(partial, engine="netcdf4")
        with replacing(self.path / "table.md") as partial:
            partial.write_text(table(dataset), encoding="utf-8")
        draw(dataset, self.path)

    def history(self, member: Member) -> Path | None:
        """Its history; None where it left none."""
        path = self.directory(member) / "history.nc"
        return path if path.exists() and path.stat().st_size else None
