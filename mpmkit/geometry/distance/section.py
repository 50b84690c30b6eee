"""The distance of a plane region between straight edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...contracts.solid import Found, HalfSpace, Solid
from ...kernels.sections import section_distance

Loop = list[tuple[float, float]]


@dataclass(frozen=True)
class Section(Solid):
    """A plane region with straight edges; ``start`` and ``end``, m, (edges, 2), with the region on the left.

    φ is exact to rounding, see ``section_distance``.
    """

    start: np.ndarray
    end: np.ndarray

    @classmethod
    def of(cls, loops: Sequence[Loop], shift: Sequence[float] = (0.0, 0.0)) -> Section:
        """The region that loops of corners, m, go around with the region on their left."""
        starts, ends = [], []
        for loop in loops:
            corners = np.array(loop, dtype=float) + shift
            following = np.roll(corners, -1, axis=0)
            real = (corners != following).any(axis=1)
            starts.append(corners[real])
            ends.append(following[real])
        return cls(np.concatenate(starts), np.concatenate(ends))

    def distance(self, x: np.ndarray) -> Found:
        return section_distance(np.ascontiguousarray(x, dtype=float), self.start, self.end)

    def outsides(self, radial: bool) -> tuple[Solid, ...]:
        """A half-space for each edge, where the region is convex."""
        along = self.end - self.start
        inwards = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
        depth = np.einsum("pec,ec->pe", self.start[:, None] - self.start, inwards)
        if depth.min() < -1e-9 * np.ptp(self.start, axis=0).max():
            return super().outsides(radial)
        return tuple(
            HalfSpace(start, n)
            for start, end, n in zip(self.start, self.end, inwards, strict=True)
            if not radial or max(start[0], end[0]) > 0
        )

    def hull(self) -> tuple[np.ndarray, float]:
        return self.start, 0.0


def trapezium(bottom: float, top: float, height: float) -> list[Loop]:
    """The loop of a trapezium of half-widths ``bottom`` and ``top``, m, on the middle of its base."""
    return [[(-bottom, 0.0), (bottom, 0.0), (top, height), (-top, height)]]


def trapezium_shell(
    bottom: float, top: float, height: float, thickness: float, open_ends: Sequence[str]
) -> list[Loop]:
    """The loops of a shell around a trapezium, flush with it at ``open_ends``, of "bottom" and "top".

    Its sides are as thick as asked for, m, along their normals; its rims and its outer corners are flat.
    """
    slope = (top - bottom) / height
    low = 0.0 if "bottom" in open_ends else -thickness
    high = height if "top" in open_ends else height + thickness

    def outer(z: float) -> float:
        return bottom + slope * z + thickness * float(np.hypot(1.0, slope))

    # Left and right, at the bottom (0) and at the top (1); capitals are outside.
    l0, r0, l1, r1 = (-bottom, 0.0), (bottom, 0.0), (-top, height), (top, height)
    L0, R0, L1, R1 = (-outer(low), low), (outer(low), low), (-outer(high), high), (outer(high), high)
    if "bottom" in open_ends and "top" in open_ends:
        return [[r0, R0, R1, r1], [L0, l0, l1, L1]]
    if "top" in open_ends:
        return [[L0, R0, R1, r1, r0, l0, l1, L1]]
    if "bottom" in open_ends:
        return [[R1, L1, L0, l0, l1, r1, r0, R0]]
    return [[L0, R0, R1, L1], [r0, l0, l1, r1]]


def trapezium_plates(
    bottom: float, top: float, height: float, thickness: float, open_ends: Sequence[str]
) -> list[list[Loop]]:
    """The loops of the parts of ``trapezium_shell`` that meet in its inner edges: its sides, and a plate at
    each closed end. They overlap, so that none ends in an edge. An end that is a point has no plate."""
    radii = {"bottom": bottom, "top": top}
    plated = [end for end in ("bottom", "top") if end not in open_ends and radii[end] > 0]
    if not plated:
        return [trapezium_shell(bottom, top, height, thickness, open_ends)]
    slope = (top - bottom) / height

    def outer(z: float) -> float:
        return bottom + slope * z + thickness * float(np.hypot(1.0, slope))

    def plate(low: float, high: float) -> list[Loop]:
        return [[(-outer(low), low), (outer(low), low), (outer(high), high), (-outer(high), high)]]

    low = 0.0 if "bottom" in open_ends else -thickness
    high = height if "top" in open_ends else height + thickness
    inner = [(top, high), (top, height), (bottom, 0.0), (bottom, low)]
    right = [(outer(low), low), (outer(high), high), *inner]
    left = [(-r, z) for r, z in reversed(right)]
    levels = {"bottom": (low, 0.0), "top": (height, high)}
    return [[right, left], *(plate(*levels[end]) for end in plated)]
