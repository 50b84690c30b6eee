"""The directory of a study: the results of each member, so that no member is run twice."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, TypeGuard

import xarray

from ..errors import CaseError
from ..output import write_json
from ..output.atomic import cannot_write, replacing
from ..output.lock import LOCK_NAME, alone_in
from ..output.netcdf import write_dataset
from .members import Member, members_of, shown
from .model import Study
from .table import table
from .work import FAILED, Outcome

DRAWN = ("table.md", "histories.png", "differences.png", "chart.png", "index.html")
"""Files made from all members together, besides ``results.nc``."""
PAGE = "index.html"
"""Page of a member, in its directory."""
KINDS = {"labels": dict, "fate": str, "sentence": str, "summary": dict, "cost": dict}
"""Keys of every ``member.json``."""


class Store:
    """``study.json``, ``results.nc``, ``table.md``, figures, and ``members/`` with a directory each.

    Args:
        path: the directory; a leading ``~`` is the home folder.
        overwrite: whether existing results that the study cannot continue from may be replaced.
    """

    def __init__(self, path: Path, overwrite: bool = False) -> None:
        self.path = Path(os.path.expanduser(path))
        self.overwrite = overwrite
        self.study = self.path / "study.json"
        self.results = self.path / "results.nc"

    @contextmanager
    def claimed(self, study: Study, members: list[Member] | None = None) -> Iterator[None]:
        """As ``open``, and lock the directory against other studies inside the block.

        Raises:
            CaseError: the directory contains files that must not be replaced.
            OutputError: it cannot be written, or another study is running there.
        """
        self._make()
        with alone_in(self.path, "study"):
            self.open(study, members)
            yield

    def open(self, study: Study, members: list[Member] | None = None) -> None:
        """Make the directory, or continue in one that holds a study.

        Args:
            study: that is to be run.
            members: of the study; default: as ``members_of`` makes them.

        Raises:
            CaseError: the directory contains files that must not be replaced.
            OutputError: it cannot be written.
        """
        self._make()
        lost = self._replaced_by(members_of(study) if members is None else members)
        if lost and not self.overwrite:
            more = f" and of {len(lost) - 1} more" if len(lost) > 1 else ""
            raise CaseError(
                f"'{self.path}' holds results that this study would replace, those of the member "
                f"'{next(iter(lost.values()))}'{more}: give --overwrite to replace them, or --out DIR to "
                "write elsewhere"
            )
        if lost:
            self._clear(lost)
        write_json(self.study, study.model_dump(mode="json"))

    def _make(self) -> None:
        try:
            filled = self.path.exists() and any(path.name != LOCK_NAME for path in self.path.iterdir())
            if filled and not self.study.exists():
                raise CaseError(f"'{self.path}' exists and holds no study; choose another with --out")
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(self.path, error) from error

    def _replaced_by(self, members: list[Member]) -> dict[Path, str]:
        """Directories and names of stored members that the study does not have, or has with another case.

        Failed members are left out: they have no result. A member with the same case but another version of
        mpmkit or of a plug-in is run again and replaced.
        """
        wanted = {self.directory(member): member for member in members}
        lost = {}
        for path in sorted(self.path.glob("members/*/member.json")):
            record = _record(path)
            if record is None or record["fate"] == FAILED:
                continue
            member = wanted.get(path.parent)
            if member is None or member.case_digest != record.get("case_digest"):
                lost[path.parent] = ", ".join(map(shown, record["labels"].values()))
        return lost

    def _clear(self, directories: Iterable[Path]) -> None:
        """Delete the files of these members and the files made from all members; nothing else."""
        try:
            for directory in directories:
                for name in ("member.json", "history.nc", "case.json", PAGE):
                    (directory / name).unlink(missing_ok=True)
                with suppress(OSError):  # it contains a file of the user
                    directory.rmdir()
            for path in (self.results, *(self.path / name for name in DRAWN)):
                path.unlink(missing_ok=True)
        except OSError as error:
            raise cannot_write(self.path, error) from error

    def directory(self, member: Member) -> Path:
        return self.path / "members" / member.slug

    def keep(self, member: Member, outcome: Outcome) -> None:
        """Write the result of a member; ``member.json`` is written last and shows that it is complete."""
        directory = self.directory(member)
        try:
            directory.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(directory, error) from error
        with replacing(directory / "history.nc") as partial:
            partial.write_bytes(outcome.history)
        write_json(directory / "case.json", member.data)
        self._keep_page(directory / PAGE, outcome.page)
        record = asdict(outcome)
        record.pop("history")
        record.pop("page")
        digests = {
            "digest": member.digest,
            "case_digest": member.case_digest,
            "history_digest": _digest(outcome.history),
        }
        write_json(directory / "member.json", {"labels": member.labels, **digests, **record})

    @staticmethod
    def _keep_page(path: Path, content: bytes) -> None:
        """Write the page of a member; without one, that of an earlier run must not stay."""
        try:
            if not content:
                path.unlink(missing_ok=True)
                return
        except OSError as error:
            raise cannot_write(path, error) from error
        with replacing(path) as partial:
            partial.write_bytes(content)

    def outcome(self, member: Member) -> dict[str, Any] | None:
        """The stored result of a member with the same case and versions; None if there is none.

        A damaged result counts as missing, so that the member is run again.
        """
        record = _record(self.directory(member) / "member.json")
        return record if self._is_of(record, member) and self._whole(record, member) else None

    def damaged(self, member: Member) -> Path | None:
        """A file of a finished member that was changed or lost; None if there is none."""
        path = self.directory(member) / "member.json"
        record = _record(path)
        if record is None:
            return path if path.exists() else None
        if not self._is_of(record, member) or self._whole(record, member):
            return None
        return self._history(member)

    @staticmethod
    def _is_of(record: dict[str, Any] | None, member: Member) -> TypeGuard[dict[str, Any]]:
        return record is not None and record.get("digest") == member.digest

    def _whole(self, record: dict[str, Any], member: Member) -> bool:
        try:
            content = self._history(member).read_bytes()
        except OSError:
            content = b""
        return record.get("history_digest") == _digest(content)

    def settled(self, member: Member) -> bool:
        """Whether a repeated run would end in the same way: finished, or stopped by a guard.

        A failed member may have failed because of the machine or a missing package.
        """
        record = self.outcome(member)
        return record is not None and record["fate"] != FAILED

    def write(self, dataset: xarray.Dataset) -> None:
        """Write ``results.nc``, ``table.md``, the figures and the page."""
        from .figures import draw
        from .page import write_page

        write_dataset(dataset, self.results)
        with replacing(self.path / "table.md") as partial:
            partial.write_text(table(dataset), encoding="utf-8")
        draw(dataset, self.path)
        write_page(dataset, self.path)

    def history(self, member: Member) -> Path | None:
        """Its history; None if there is none."""
        path = self._history(member)
        return path if path.exists() and path.stat().st_size else None

    def page(self, member: Member) -> Path | None:
        """Its page; None if there is none."""
        path = self.directory(member) / PAGE
        return path if path.exists() else None

    def _history(self, member: Member) -> Path:
        return self.directory(member) / "history.nc"


def _record(path: Path) -> dict[str, Any] | None:
    """The content of a ``member.json``; None if it is not valid."""
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    if not isinstance(record, dict):
        return None
    return record if all(isinstance(record.get(key), kind) for key, kind in KINDS.items()) else None


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
