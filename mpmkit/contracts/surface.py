"""Contract of a surface: where a wall is, and how it moves."""

from __future__ import annotations

from typing import ClassVar, Protocol

import numpy as np

from ..spaces import Space
from .base import Plugin


class PlacedSurface(Protocol):
    """A surface in its space. Points are in the coordinates of the case file; k of them at once.

    It may also have a ``thickness``, m, if there is room for material on both sides of the wall. Without it,
    or with None, the wall fills all the space behind its surface.

    It may have ``parts``, a sequence of surfaces without inner edges that form the wall together. A node in
    an inner edge knows one face of each part.
    """

    def distance(self, x: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Distance d, m, ``(k,)``, of points ``x``, m, ``(k, dim)``, and its gradient n, ``(k, dim)``, at a
        time, s.

        d > 0 where material may be, d < 0 in the wall; n is the unit normal into the material at the point
        of the surface that is nearest. Far from the wall it may be any unit vector.
        """

    def velocity(self, x: np.ndarray, t: float) -> np.ndarray:
        """Velocity, m/s, ``(k, dim)``, of the wall's material at the points of the surface nearest to ``x``.

        It may have a part along the surface, as of a drum that turns about its axis.
        """

    def fastest(self, t0: float, t1: float) -> float:
        """Upper bound, m/s, of that velocity between two times, s; it limits the time step."""

    def present(self, t: float) -> bool:
        """Whether the wall is there at a time, s."""


class Surface(Plugin):
    """Where a wall is, and how it moves.

    In a case it is at ``walls.<name>.surface``, as ``{"kind": name, …parameters}``.
    """

    named_by: ClassVar[str] = "kind"

    def problem(self, space: Space) -> str | None:
        """Why a space cannot hold the surface, in one sentence that names the parameter; None if it can."""
        return None

    def placed(self, space: Space) -> PlacedSurface:
        """The surface in its space; called once; default: the surface itself."""
        return self

    def distance(self, x: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
        """See ``PlacedSurface``; required if ``placed`` is not overridden."""
        raise NotImplementedError

    def velocity(self, x: np.ndarray, t: float) -> np.ndarray:
        """See ``PlacedSurface``; default: at rest."""
        return np.zeros_like(x)

    def fastest(self, t0: float, t1: float) -> float:
        """See ``PlacedSurface``; default: at rest."""
        return 0.0

    def present(self, t: float) -> bool:
        """See ``PlacedSurface``; always there by default."""
        return True
