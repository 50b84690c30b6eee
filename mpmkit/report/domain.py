"""The domain in a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..spaces import SPACES
from .run_results import RunResults


def columns(results: RunResults) -> dict[str, int]:
    """Column of each axis of the scene in the positions of a frame."""
    return {axis: column for column, axis in enumerate(SPACES[results.case["space"]].axes)}


@dataclass(frozen=True)
class Domain:
    """The domain in the plane of the picture; lengths along (horizontal, vertical), m."""

    lower: np.ndarray
    upper: np.ndarray
    period: tuple[float | None, float | None]
    """Periods of the scene, m; None along an axis that is not periodic."""
    wall: tuple[tuple[bool, bool], tuple[bool, bool]]
    """Whether the lower and the upper end along each axis are walls."""
    mirror: float | None
    """Position of an axis or plane of symmetry; the other half of the scene is drawn as well."""
    floor: float | None
    """Height of the floor; None if the lower face of the domain is not a wall."""


def domain_of(results: RunResults) -> Domain:
    """The domain of a run, including the part behind its plane of symmetry."""
    grid, axes = results.case["grid"], ("r" if results.case["space"] == "axisymmetric" else "x", "z")
    faces = grid.get("faces", {})
    lower, upper = np.array([grid["domain"][axis] for axis in axes], dtype=float).T
    period = tuple(
        float(high - low) if faces.get(f"{axis}_min") == "periodic" else None
        for axis, low, high in zip(axes, lower, upper, strict=True)
    )
    wall = [
        [faces.get(f"{axis}_{side}", "open") not in ("open", "periodic") for side in ("min", "max")]
        for axis in axes
    ]
    floor = float(lower[1]) if wall[1][0] else None
    mirror = 0.0 if axes[0] == "r" else symmetry_plane(results, "x")
    if mirror is not None:
        far = upper[0] if mirror == lower[0] else lower[0]
        lower[0], upper[0] = sorted((far, 2 * mirror - far))
        wall[0] = [wall[0][1] if mirror < far else wall[0][0]] * 2  # that of the far face, on both sides
    (left, right), (bottom, top) = wall
    return Domain(lower, upper, (period[0], period[1]), ((left, right), (bottom, top)), mirror, floor)


def symmetry_plane(results: RunResults, axis: str) -> float | None:
    """Position of a plane of symmetry at the end of the domain along an axis, m; None if there is none."""
    grid = results.case["grid"]
    for side, bound in zip(("min", "max"), grid["domain"][axis], strict=True):
        if grid.get("faces", {}).get(f"{axis}_{side}") == "symmetry":
            return bound
    return None


def inside(results: RunResults, position: np.ndarray) -> np.ndarray:
    """Which of the positions ``(n, 3)`` are finite and in the domain, extended by a cell."""
    grid, kept, column = results.case["grid"], np.isfinite(position).all(axis=1), columns(results)
    for axis, (low, high) in grid["domain"].items():
        along = position[:, column[axis]]
        kept &= (along >= low - grid["cell_size"]) & (along <= high + grid["cell_size"])
    return kept
