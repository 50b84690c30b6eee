"""The interface of all solids, and solids composed of others."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

Found = tuple[np.ndarray, np.ndarray]
"""Signed distances φ, m, (k,), and their gradients, unit vectors, (k, dim)."""


class Solid(ABC):
    """A set of points with a signed distance φ: above 0 outside, below 0 inside.

    The gradient ∇φ is that at the nearest point of the surface; of several nearest points, one is used.
    """

    @abstractmethod
    def distance(self, x: np.ndarray) -> Found:
        """φ, m, (k,), and ∇φ, (k, dim), at points, m, (k, dim)."""

    @abstractmethod
    def hull(self) -> tuple[np.ndarray, float] | None:
        """Points, m, (m, dim), and a radius, m: no point of its surface is farther from the convex hull of
        the points; None if the surface has no end."""

    def parts(self, radial: bool) -> tuple[Solid, ...]:
        """Solids whose union is this one, if its surface has inner edges: each has a smooth surface there.

        Args:
            radial: whether the first coordinate is the radius; parts behind the axis are left out.
        """
        return (self,)

    def outsides(self, radial: bool) -> tuple[Solid, ...]:
        """Solids whose union is the space around this one, see ``parts``; one per face of a convex solid."""
        return (Inverted(self),)

    def extent(self) -> float:
        """Its least extent along an axis, m; infinite if it has no end."""
        found = self.hull()
        return np.inf if found is None else float(np.ptp(found[0], axis=0).min()) + 2 * found[1]


@dataclass(frozen=True)
class HalfSpace(Solid):
    """φ = (x - point)·normal: the half-space behind a plane. Both are (dim,), the normal of length 1."""

    point: np.ndarray
    normal: np.ndarray

    def distance(self, x: np.ndarray) -> Found:
        return (x - self.point) @ self.normal, np.tile(self.normal, (len(x), 1))

    def hull(self) -> None:
        return None


@dataclass(frozen=True)
class Inverted(Solid):
    """-φ: the space around a solid."""

    solid: Solid

    def distance(self, x: np.ndarray) -> Found:
        distance, gradient = self.solid.distance(x)
        return -distance, -gradient

    def parts(self, radial: bool) -> tuple[Solid, ...]:
        return self.solid.outsides(radial)

    def hull(self) -> tuple[np.ndarray, float] | None:
        return self.solid.hull()


@dataclass(frozen=True)
class Jointed(Solid):
    """A solid with known parts. Parts overlap where they meet, and none ends at an inner edge."""

    whole: Solid
    pieces: tuple[Solid, ...]

    def distance(self, x: np.ndarray) -> Found:
        return self.whole.distance(x)

    def parts(self, radial: bool) -> tuple[Solid, ...]:
        return self.pieces

    def hull(self) -> tuple[np.ndarray, float] | None:
        return self.whole.hull()


@dataclass(frozen=True)
class Shell(Solid):
    """|φ - t/2| - t/2: the points outside a solid within the thickness t, m.

    The outer surface is rounded around the edges of the solid. φ of a point in the shell is exact if the
    outer surface has no fold closer to the point than the thickness.
    """

    solid: Solid
    thickness: float

    def distance(self, x: np.ndarray) -> Found:
        distance, gradient = self.solid.distance(x)
        off_middle = distance - self.thickness / 2
        return np.abs(off_middle) - self.thickness / 2, np.where(off_middle < 0, -1.0, 1.0)[
            :, None
        ] * gradient

    def hull(self) -> tuple[np.ndarray, float] | None:
        inner = self.solid.hull()
        return None if inner is None else (inner[0], inner[1] + self.thickness)
