"""A vertical section through the material of a frame, as rectangles in the plane of the picture."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..output import read_frame
from .run_results import RunResults


@dataclass(frozen=True)
class Section:
    """The particle domains cut by a vertical plane; lengths along (horizontal, vertical)."""

    centre: np.ndarray
    """``(n, 2)``, m."""
    half_size: np.ndarray
    """``(n, 2)``, m."""
    speed: np.ndarray
    """``(n,)``, m/s."""

    @property
    def lower(self) -> np.ndarray:
        return (self.centre - self.half_size).min(axis=0)

    @property
    def upper(self) -> np.ndarray:
        return (self.centre + self.half_size).max(axis=0)


def plane_of(results: RunResults) -> float | None:
    """The y, m, of the section through a 3-D scene: its plane of symmetry, else its middle at the start."""
    if results.case["space"] != "3d":
        return None
    symmetry = _symmetry_plane(results, "y")
    if symmetry is not None:
        return symmetry
    frame = read_frame(results.frames[0][1])
    return float(np.average(frame["position"][:, 1], weights=frame["half_size"].prod(axis=1)))


def section_of(path: Path, results: RunResults, plane: float | None) -> Section:
    """The section through a frame along y = ``plane``, m, or all of it where that is None.

    Half a body, cut at its axis or at a plane of symmetry, is drawn whole.
    """
    frame = read_frame(path)
    position, half_size, speed = frame["position"], frame["half_size"], frame["speed"]
    if plane is not None:
        distance = np.abs(position[:, 1] - plane)
        # Drawn from the farthest to the nearest, so that what the plane cuts lies on top.
        order = np.argsort(-distance)
        drawn = order[distance[order] <= results.case["grid"]["cell_size"]]
        position, half_size, speed = position[drawn], half_size[drawn], speed[drawn]
    centre, half_size = position[:, [0, 2]], half_size[:, [0, 2]]
    mirror = 0.0 if results.case["space"] == "axisymmetric" else _symmetry_plane(results, "x")
    if mirror is not None:
        reflected = centre * [-1, 1] + [2 * mirror, 0]
        centre, half_size = np.concatenate([reflected, centre]), np.tile(half_size, (2, 1))
        speed = np.tile(speed, 2)
    return Section(centre, half_size, speed)


def _symmetry_plane(results: RunResults, axis: str) -> float | None:
    grid = results.case["grid"]
    for side, bound in zip(("min", "max"), grid["domain"][axis], strict=True):
        if grid.get("faces", {}).get(f"{axis}_{side}") == "symmetry":
            return bound
    return None
