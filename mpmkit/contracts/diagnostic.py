"""Contracts of measured quantities: columns of the history, and fields of particles."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from .base import Plugin
from .surface import Space


@dataclass(frozen=True)
class Column:
    """A number in every row of the history."""

    name: str
    """lower-case letters, digits and ``_``; in the history ``<name of the diagnostic>.<name>``"""
    unit: str
    long_name: str


class Observed(Protocol):
    """A scene as diagnostics and particle fields see it. Arrays have an entry for each particle, and are
    read-only.

    Places are in the coordinates of the case. In two dimensions the axes of tensors are the two of the grid
    and the one out of the plane; volumes and masses are per metre of depth in plane strain, and of the whole
    ring in axisymmetry.
    """

    @property
    def space(self) -> Space:
        """The space of the case."""

    @property
    def time(self) -> float:
        """s"""

    @property
    def cell_size(self) -> float:
        """m"""

    @property
    def number(self) -> np.ndarray:
        """(n,) number of each particle, which it keeps for the whole run"""

    @property
    def body(self) -> np.ndarray:
        """(n,) number of its body"""

    @property
    def position(self) -> np.ndarray:
        """(n, dim) m"""

    @property
    def velocity(self) -> np.ndarray:
        """(n, dim) m/s"""

    @property
    def half_size(self) -> np.ndarray:
        """(n, dim) half the sides of the particle's box, m"""

    @property
    def mass(self) -> np.ndarray:
        """(n,) kg"""

    @property
    def volume(self) -> np.ndarray:
        """(n,) m³"""

    @property
    def pressure(self) -> np.ndarray:
        """(n,) minus the mean normal stress, Pa, positive in compression"""

    @property
    def stress(self) -> np.ndarray:
        """(n, 6) Cauchy stress, Pa, positive in tension, in the Voigt order of the laws"""

    @property
    def shear_stress(self) -> np.ndarray:
        """(n,) √(s:s/2) of the stress deviator s, Pa"""

    @property
    def shear_rate(self) -> np.ndarray:
        """(n,) √(2 D':D'), 1/s"""

    @property
    def velocity_gradient(self) -> np.ndarray:
        """(n, 3, 3) 1/s"""

    def state(self, name: str) -> np.ndarray:
        """A state variable of the laws, ``(n,)`` or ``(n, k)``; ``nan`` where a law has no such variable."""

    def wall_distance(self, name: str) -> np.ndarray:
        """Distance, m, ``(n,)``, of the particles' places from a wall of the case, or a face of its grid."""


class Diagnostic(Plugin):
    """Numbers that every row of the history holds.

    In a case it stands at ``output.diagnostics.<name>``, as ``{"kind": name, …parameters}``.
    """

    named_by: ClassVar[str] = "kind"

    def problem(self, space: Space, walls: Sequence[str]) -> str | None:
        """Why it cannot be measured in a space with walls and faces of these names, in one sentence that
        names the parameter; None if it can."""
        return None

    @abstractmethod
    def columns(self, space: Space) -> Sequence[Column]:
        """The columns that it measures; the same for the whole run."""

    @abstractmethod
    def measure(self, scene: Observed) -> Mapping[str, float]:
        """One number for each column, by its name; ``nan`` where it has no value."""


class ParticleField(Plugin):
    """A field of the particles, for frames and for ``output.particle_history``.

    In a case it stands at ``output.fields.<name>``, as ``{"kind": name, …parameters}``.
    """

    named_by: ClassVar[str] = "kind"
    unit: ClassVar[str]
    long_name: ClassVar[str]
    shape: ClassVar[tuple[int, ...]] = ()
    """of an entry: ``()`` for a number, ``(k,)`` for k of them"""

    @abstractmethod
    def values(self, scene: Observed) -> np.ndarray:
        """The field, ``(n, *shape)``, each entry computed from its own particle only."""
