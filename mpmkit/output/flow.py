"""The flow of a run for its page: a few fields of some particles at some moments."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ..errors import CaseError
from .atomic import replacing


@dataclass(frozen=True)
class Moment:
    """Particles at one time, in the order of their numbers."""

    time: float
    """s"""
    share: float
    """part of all particles that is stored"""
    number: np.ndarray
    """(n,) name of each particle through the run"""
    body: np.ndarray
    """(n,) number of its body"""
    yielded: np.ndarray
    """(n,) 1 where the material has yielded, else 0"""
    position: np.ndarray
    """(n, dim), m"""
    half_size: np.ndarray
    """(n, dim) half sides of its box, m"""
    speed: np.ndarray
    """(n,), m/s"""
    shear_rate: np.ndarray
    """(n,), 1/s"""
    pressure: np.ndarray
    """(n,), Pa, positive in compression"""
    added: Mapping[str, np.ndarray] = field(default_factory=dict)
    """(n,) state variables of the laws, and fields of the case, by name; NaN where a particle has none"""

    def __len__(self) -> int:
        return len(self.number)

    def only(self, kept: np.ndarray, share: float = 1.0) -> Moment:
        """The moment with the given particles, a part ``share`` of its present ones."""
        arrays = {name: getattr(self, name)[kept] for name in TYPES}
        added = {name: values[kept] for name, values in self.added.items()}
        return replace(self, share=self.share * share, added=added, **arrays)

    def copied(self) -> Moment:
        """The moment with arrays of its own."""
        return self.only(np.ones(len(self), dtype=bool))

    def values(self, name: str) -> np.ndarray:
        """A field of the moment, or one of those ``added``, ``(n,)``; NaN if the moment does not have it."""
        if name in TYPES:
            return getattr(self, name)
        return self.added.get(name, np.full(len(self), np.nan, dtype=np.float32))


TYPES = {
    "number": np.uint32,
    "body": np.uint8,
    "yielded": np.uint8,
    "position": np.float32,
    "half_size": np.float16,
    "speed": np.float16,
    "shear_rate": np.float16,
    "pressure": np.float32,
}
"""Type of each array; half precision is accurate to a part in 2000."""
ADDED = "added."
"""Before the names of added fields in a file, where they are in single precision."""
LARGEST = float(np.finfo(np.float16).max)
"""Largest value in half precision; larger values are cut to it."""


def moment_of(
    time: float,
    share: float,
    fields: Mapping[str, np.ndarray],
    added: Mapping[str, np.ndarray] | None = None,
) -> Moment:
    """A moment of arrays ``fields``, by the names of ``TYPES``, and of ``added`` ones, by any name.

    The particles may be in any order.
    """
    order = np.argsort(fields["number"], kind="stable")
    arrays = {}
    with np.errstate(over="ignore", invalid="ignore"):  # of a run that a guard will stop
        for name, kind in TYPES.items():
            values = np.asarray(fields[name])[order]
            arrays[name] = (np.minimum(values, LARGEST) if kind == np.float16 else values).astype(kind)
        more = {name: np.asarray(values)[order].astype(np.float32) for name, values in (added or {}).items()}
    return Moment(float(time), float(share), **arrays, added=more)


def arrays_of(moments: Sequence[Moment]) -> dict[str, np.ndarray]:
    """Moments as a few arrays: ``time``, ``share``, ``count``, and each field of all moments end to end."""
    found = {
        "time": np.array([moment.time for moment in moments]),
        "share": np.array([moment.share for moment in moments]),
        "count": np.array([len(moment) for moment in moments], dtype=np.int64),
    }
    for name, kind in TYPES.items():
        parts = [getattr(moment, name) for moment in moments]
        found[name] = np.concatenate(parts) if parts else np.zeros(0, dtype=kind)
    for name in dict.fromkeys(name for moment in moments for name in moment.added):
        found[f"{ADDED}{name}"] = np.concatenate([moment.values(name) for moment in moments])
    return found


def moments_of_arrays(arrays: Mapping[str, np.ndarray]) -> list[Moment]:
    """The moments from ``arrays_of``; raises KeyError if an entry is missing."""
    cuts = np.cumsum(arrays["count"])[:-1]
    own = {name: np.split(arrays[name], cuts) for name in TYPES}
    added = {
        name.removeprefix(ADDED): np.split(values, cuts)
        for name, values in arrays.items()
        if name.startswith(ADDED)
    }
    return [
        Moment(
            float(time),
            float(share),
            **{name: of[row] for name, of in own.items()},
            added={name: of[row] for name, of in added.items()},
        )
        for row, (time, share) in enumerate(zip(arrays["time"], arrays["share"], strict=True))
    ]


def write_flow(path: Path, arrays: Mapping[str, np.ndarray]) -> None:
    """Write the arrays of moments; the file at ``path`` is complete at any time.

    Raises:
        OutputError: where it cannot be written.
    """
    with replacing(path) as partial, partial.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)


def read_flow(path: Path) -> list[Moment]:
    """The moments in a file; an empty list if there is no file.

    Raises:
        CaseError: the file is not valid.
    """
    if not path.is_file():
        return []
    try:
        with np.load(path, allow_pickle=False) as arrays:
            return moments_of_arrays(arrays)
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise CaseError(f"'{path}' does not hold the flow of a run: {error}") from error
