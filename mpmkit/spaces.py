"""The spaces of a scene: how many axes the grid has, what they are called, and what a volume is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Space:
    """A space; its last axis is the vertical one.

    Extensive quantities are of the whole body: of the full circle in an axisymmetric scene, of one metre of
    thickness in plane strain. Stress and rate of deformation are 3 × 3 in each; the components that the
    grid does not resolve stand at index 2 (out of the plane, or the hoop direction).
    """

    name: str
    axes: tuple[str, ...]
    radial: bool = False

    @property
    def dim(self) -> int:
        return len(self.axes)

    @property
    def faces(self) -> tuple[str, ...]:
        """Names of the faces of the domain, lower before upper, axis by axis."""
        return tuple(f"{axis}_{side}" for axis in self.axes for side in ("min", "max"))

    def particle_volume(self, position: np.ndarray, size: np.ndarray) -> np.ndarray:
        """Volume, m³, of boxes with sides ``size`` (n, dim) or (dim,) centred at ``position`` (n, dim)."""
        area = np.broadcast_to(np.prod(size, axis=-1), len(position))
        return 2 * np.pi * position[:, 0] * area if self.radial else area.copy()


SPACES = {
    space.name: space
    for space in (
        Space("3d", ("x", "y", "z")),
        Space("plane-strain", ("x", "z")),
        Space("axisymmetric", ("r", "z"), radial=True),
    )
}
