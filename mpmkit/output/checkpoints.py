"""Checkpoints, to continue a stopped run. Each has a checksum, and the last two are kept."""

from __future__ import annotations

import hashlib
import io
import json
import logging
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from ..errors import CaseError
from .atomic import replacing

LOGGER = logging.getLogger("mpmkit")
KEPT = 2
"""Number of checkpoints kept: if the last one is damaged, the one before it is used."""
ANY_VERSION = b"mpmkit checkpoint "
MAGIC = ANY_VERSION + b"2 sha256 "
WORDS = "words"
"""Entry of the archive with all data that are not arrays, as JSON."""


class Damaged(Exception):
    """A file that is not a complete checkpoint."""


class OfAnotherVersion(Damaged):
    """A checkpoint that another version of mpmkit wrote."""


class Checkpoints:
    """The checkpoints of one run.

    A file is a line with a checksum and a NumPy archive; nothing in it is ever executed.
    """

    def __init__(self, directory: Path) -> None:
        self.directory = Path(directory)

    def write(self, step: int, arrays: Mapping[str, np.ndarray], words: Mapping[str, Any]) -> None:
        """Add a checkpoint, and remove those that are older than the one before.

        Raises:
            OutputError: it cannot be written; existing ones are kept.
        """
        content = io.BytesIO()
        text = np.frombuffer(json.dumps(words).encode(), dtype=np.uint8)
        np.savez(content, allow_pickle=False, **{WORDS: text, **arrays})
        body = content.getbuffer()
        path = self.directory / f"step_{step:012d}.checkpoint"
        with replacing(path) as partial:
            self.directory.mkdir(exist_ok=True)
            with partial.open("wb") as file:
                file.write(MAGIC + hashlib.sha256(body).hexdigest().encode() + b"\n")
                file.write(body)
                file.flush()
                os.fsync(file.fileno())  # otherwise a power cut may keep the rename but lose the content
        for old in self.paths()[KEPT:]:
            with suppress(OSError):
                old.unlink()

    def newest(self) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Arrays and other data of the last valid checkpoint.

        Raises:
            CaseError: there is none, or another version of mpmkit wrote it.
        """
        for path in self.paths():
            try:
                return read(path)
            except OfAnotherVersion:
                raise CaseError(
                    f"the checkpoint '{path}' was written by another version of mpmkit and cannot be read by "
                    "this one: go on with that version, or run the case again"
                ) from None
            except Damaged as damage:
                LOGGER.warning("the checkpoint '%s' %s; the one before it is used", path, damage)
        raise CaseError(f"'{self.directory}' has no checkpoint to go on from")

    def paths(self) -> list[Path]:
        """Files of the checkpoints, the newest first."""
        return sorted(self.directory.glob(f"step_{'[0-9]' * 12}.checkpoint"), reverse=True)

    def keep_last(self) -> None:
        """Remove all of them but the newest."""
        with suppress(OSError):
            for path in (*self.paths()[1:], *self.directory.glob(".*.partial")):
                path.unlink()

    def remove(self) -> None:
        """Remove all of them, and their directory if nothing else is in it."""
        with suppress(OSError):
            for path in (*self.paths(), *self.directory.glob(".*.partial")):
                path.unlink()
            self.directory.rmdir()


def read(path: Path) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Arrays and other data of a checkpoint.

    Raises:
        Damaged: it cannot be read, or its content has changed.
    """
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise Damaged(f"cannot be read: {error.strerror}") from error
    head, _, body = content.partition(b"\n")
    if head.startswith(ANY_VERSION) and not head.startswith(MAGIC):
        raise OfAnotherVersion("is of another version")
    if not head.startswith(MAGIC):
        raise Damaged("is none")
    if hashlib.sha256(body).hexdigest().encode() != head[len(MAGIC) :]:
        raise Damaged("is damaged: its checksum is wrong")
    try:
        with np.load(io.BytesIO(body), allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        return arrays, json.loads(arrays.pop(WORDS).tobytes())
    except (
        OSError,
        ValueError,
        KeyError,
        BadZipFile,
    ) as error:  # ValueError: objects that would need unpickling
        raise Damaged("has content that no checkpoint has") from error
