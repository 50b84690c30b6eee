"""The view of a three-dimensional scene: a parallel projection, turned and tilted, of the whole body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...output import read_wall_frame
from ..domain import symmetry_plane
from ..run_results import RunResults

AZIMUTH, ELEVATION = np.radians(-60.0), np.radians(22.0)
"""Direction of the camera: angle about the vertical axis from x, and angle above the horizon."""


@dataclass(frozen=True)
class View:
    """Unit vectors of the picture in the scene: to the right, up, and towards the eye."""

    right: np.ndarray
    up: np.ndarray
    towards: np.ndarray

    def seen(self, points: np.ndarray) -> np.ndarray:
        """Places ``(..., 3)``, m, in the picture: to the right, up, and towards the eye."""
        return points @ np.array([self.right, self.up, self.towards]).T


def standard_view() -> View:
    """From the front right, a little from above, as a person sees a slump test."""
    ca, sa, ce, se = np.cos(AZIMUTH), np.sin(AZIMUTH), np.cos(ELEVATION), np.sin(ELEVATION)
    return View(
        np.array([-sa, ca, 0.0]), np.array([-se * ca, -se * sa, ce]), np.array([ce * ca, ce * sa, se])
    )


def whole(results: RunResults, points: np.ndarray) -> list[np.ndarray]:
    """Points ``(..., 3)``, m, and their images in the planes of symmetry: a quarter gives four."""
    found = [points]
    for column, axis in enumerate(("x", "y", "z")):
        plane = symmetry_plane(results, axis) if axis != "z" else None
        if plane is not None:
            sign, shift = np.ones(3), np.zeros(3)
            sign[column], shift[column] = -1.0, 2 * plane
            found += [points * sign + shift for points in found]
    return found


def wall_triangles(results: RunResults, time: float) -> dict[str, np.ndarray]:
    """Triangles, m, (m, 3, 3), of the walls present in a frame, mirror images included, by name."""
    triangles = {}
    for name, path in results.walls.get(time, {}).items():
        points, parts, _ = read_wall_frame(path)
        triangles[name] = np.concatenate(whole(results, points[parts]))
    return triangles
