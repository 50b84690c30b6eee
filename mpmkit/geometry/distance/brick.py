"""The distance of a box along the axes, and of a shell around it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from ...contracts.solid import Found, HalfSpace, Solid
from .ball import unit


@dataclass(frozen=True)
class Brick(Solid):
    """The box between two corners, m, (dim,)."""

    lower: np.ndarray
    upper: np.ndarray

    def distance(self, x: np.ndarray) -> Found:
        offset = x - (self.lower + self.upper) / 2
        beyond = np.abs(offset) - (self.upper - self.lower) / 2  # of each pair of faces
        side = np.where(offset < 0, -1.0, 1.0)
        outwards, outside = unit(np.maximum(beyond, 0.0))
        nearest = np.eye(x.shape[1])[np.argmax(beyond, axis=1)]
        depth = beyond.max(axis=1)
        is_outside = depth > 0
        return (
            np.where(is_outside, outside, depth),
            side * np.where(is_outside[:, None], outwards, nearest),
        )

    def outsides(self, radial: bool) -> tuple[Solid, ...]:
        """A half-space for each face."""
        normals = np.eye(len(self.lower))
        below = [
            HalfSpace(self.lower, n)
            for axis, n in enumerate(normals)
            if not radial or axis or self.lower[0] > 0
        ]
        return (*below, *(HalfSpace(self.upper, -n) for n in normals))

    def hull(self) -> tuple[np.ndarray, float]:
        ends = np.stack([self.lower, self.upper])
        return np.array(
            [np.diagonal(ends[list(corner)]) for corner in product((0, 1), repeat=len(self.lower))]
        ), 0.0


@dataclass(frozen=True)
class BrickShell(Solid):
    """The region between a box and a larger box, which is larger by the thickness at each closed face.

    Outside, the nearest of the plates that close the faces is exact; inside, the nearer of the surfaces of
    the two boxes.

    Args:
        inner: the box, whose faces are the inner faces of the shell.
        thickness: m.
        closed: whether each face has a plate, bool, (2, dim), lower faces first; at least one has.
    """

    inner: Brick
    thickness: float
    closed: np.ndarray

    @property
    def outer(self) -> Brick:
        below, above = self.thickness * self.closed
        return Brick(self.inner.lower - below, self.inner.upper + above)

    def plates(self) -> list[Brick]:
        """One for each closed face; they overlap at edges."""
        found = []
        for side, axis in zip(*np.nonzero(self.closed), strict=True):
            lower, upper = self.outer.lower.copy(), self.outer.upper.copy()
            if side == 0:
                upper[axis] = self.inner.lower[axis]
            else:
                lower[axis] = self.inner.upper[axis]
            found.append(Brick(lower, upper))
        return found

    def parts(self, radial: bool) -> tuple[Solid, ...]:
        return tuple(plate for plate in self.plates() if not radial or plate.upper[0] > 0)

    def distance(self, x: np.ndarray) -> Found:
        around, outwards = self.outer.distance(x)
        within, from_within = self.inner.distance(x)
        inner_is_nearer = -within > around
        distance = np.where(inner_is_nearer, -within, around)
        gradient = np.where(inner_is_nearer[:, None], -from_within, outwards)
        outside = distance >= 0
        found = [plate.distance(x[outside]) for plate in self.plates()]
        nearest = np.argmin([away for away, _ in found], axis=0)
        every = np.arange(len(nearest))
        distance[outside] = np.array([away for away, _ in found])[nearest, every]
        gradient[outside] = np.array([direction for _, direction in found])[nearest, every]
        return distance, gradient

    def hull(self) -> tuple[np.ndarray, float]:
        return self.outer.hull()
