"""Contract of an initial field: velocity, stress or a law's state of a body at the start."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .base import Plugin
from .surface import Space


@dataclass(frozen=True)
class Beginning:
    """Data of a body at the start, for an initial field. Arrays are read-only."""

    space: Space
    field: str
    """Name of the field: ``velocity``, ``stress``, or ``law.`` and the name of a state variable."""
    shape: tuple[int, ...]
    """Shape of a value: ``(dim,)``, m/s, for a velocity; ``(6,)``, Pa, for a stress; that of the state."""
    position: np.ndarray
    """``(n, dim)``, m, in the coordinates of the case"""
    density: float
    """kg/m³"""
    gravity: np.ndarray
    """``(dim,)``, m/s², at the start"""
    top: float
    """Highest place of the body against gravity, -x·g/|g|, m."""


class InitialField(Plugin):
    """A field of a body at the start of a run.

    In a case it stands at ``bodies.<n>.initial.<field>``, as ``{"kind": name, …parameters}``.
    """

    named_by: ClassVar[str] = "kind"

    def problem(self, space: Space, field: str, shape: tuple[int, ...]) -> str | None:
        """Why it cannot give a field with values of this shape, in one sentence that names the parameter;
        None if it can."""
        return None

    @abstractmethod
    def at(self, start: Beginning) -> np.ndarray:
        """The field at the places, ``(n, *shape)``, each entry computed from its own place only.

        A stress is positive in tension, in the order of the laws: 00, 11, 22, 12, 02, 01 of its axes.
        """
