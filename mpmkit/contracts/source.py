"""Contract of a source, which brings material into the scene: its place and its speed."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .base import Plugin
from .surface import Space


@dataclass(frozen=True)
class Mouth:
    """The section through which material comes in: a rectangle or a disc normal to an axis of the grid."""

    centre: tuple[float, ...]
    """Its middle at the start, m, ``(dim,)``."""
    half_width: tuple[float, ...]
    """Half its width along each axis, m, ``(dim,)``; 0 along its normal."""
    axis: int
    """Axis of its normal."""
    sign: int
    """1 if material comes in along the axis, -1 if against it."""
    round: bool = False
    """Whether it is a disc, in 3-D."""


class Source(Plugin):
    """Pushes a column of material through a section, the mouth.

    The material behind the mouth is a lattice of rows that moves with the velocity

        w = du/dt + n ds/dt

    with the displacement u of the mouth (``moved``), its normal n, and the length s of the column that has
    been pushed out (``pushed``). A row is in the scene when its middle is through the mouth; until then the
    grid only sees the part of it that is near. So what comes in is known exactly: density × area × s.

    In a case it stands at ``sources.<name>``, as ``{"kind": name, "material": {…}, …parameters}``.
    """

    named_by: ClassVar[str] = "kind"

    def problem(self, space: Space, domain: tuple[np.ndarray, np.ndarray]) -> str | None:
        """Why a scene cannot have it, in one sentence that names the parameter; None if it can.

        ``domain`` has the lower and the upper corner of the grid, m.
        """
        return None

    @abstractmethod
    def mouth(self, space: Space, domain: tuple[np.ndarray, np.ndarray]) -> Mouth:
        """The section at the start."""

    @abstractmethod
    def pushed(self, t: float, area: float, density: float) -> float:
        """Length s, m, of the column that has been pushed out by a time, s; it never falls.

        Args:
            t: s.
            area: of the mouth, m²; in plane strain of 1 m of it, in an axisymmetric scene of the full circle.
            density: of the material, kg/m³.
        """

    @abstractmethod
    def fastest(self, t0: float, t1: float, area: float, density: float) -> float:
        """Upper bound, m/s, of the speed |w| of the column between two times, s."""

    def moved(self, t: float) -> np.ndarray | float:
        """Displacement u of the mouth since the start, m, ``(dim,)``; default: 0."""
        return 0.0

    def spell(self, area: float, density: float) -> tuple[float, float]:
        """When it begins and ends, s; before and after, the section is as if it were not there.

        Between them it holds what is at the mouth, also where it pushes nothing. If it ends, the length of
        the rows is chosen such that a whole number of them has come in.
        """
        return 0.0, math.inf
