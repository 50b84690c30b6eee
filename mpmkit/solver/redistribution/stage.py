"""The particles of a scene as a redistribution works on them, and when it does."""

from __future__ import annotations

import numpy as np

from ...case.model import Scheme
from ...kernels import domains
from ...kernels.compile import CHUNK
from ...kernels.nodes import OPEN, PERIODIC
from ...kernels.tensors import shear_rate
from ..grid import Grid, Window
from ..particles import Particles
from ..sorting import Sorting
from .cells import BoxCells
from .lattice import SplineLattice
from .mirrored import Mirrored

AT_A_WALL = 1e-6
"""Distance, in cells, that a shift keeps from a wall."""


class Stage:
    """The contract ``Redistributing`` made real, for one scene.

    Attributes:
        shear: largest ∫ γ̇ dt since the last redistribution, 1.
        time: s, since then.
    """

    def __init__(self, scheme: Scheme, grid: Grid, particles: Particles, radial: bool) -> None:
        self.redistribution = scheme.redistribution
        self._follows = scheme.shape.particle_domain == "strain"
        self._grid, self._particles, self._radial = grid, particles, radial
        self.shear = self.time = 0.0
        self._times = max(1, round(self._grid.cell_size / self._typical_spacing()))

    def _typical_spacing(self) -> float:
        """m, from particle to particle: that of most of them."""
        return float(np.median(self._sizes())) ** (1 / self._grid.dim)

    def _sizes(self) -> np.ndarray:
        """Volume of each particle; in axisymmetric scenes its area, so that nothing is special at the axis."""
        p = self._particles
        return p.volume / (2 * np.pi * p.position[:, 0]) if self._radial else p.volume

    # --- Every step

    def follow(self, dt: float) -> None:
        """Boxes hold the volume; the shear of a step is added."""
        p = self._particles
        largest = np.empty(len(p) // CHUNK + 1)
        largest[-1] = 0.0
        domains.hold_volume(
            p.velocity_gradient,
            p.volume,
            p.position,
            self._radial,
            p.box,
            p.half_size,
            self._follows,
            largest,
        )
        self.shear += dt * float(largest.max())
        self.time += dt

    def redistribute_if_due(self, window: Window, sorting: Sorting) -> bool:
        """Redistribute if so much shear has come together; whether it did. Particles must be sorted."""
        if not self.redistribution.is_due(self.shear):
            return False
        p = self._particles
        size = np.ascontiguousarray(self._sizes())
        self._window, self._tasks = window, sorting.tasks
        self.nodes = SplineLattice(Mirrored(self._grid, window, 1, False), sorting.tasks, p.position, size)
        self.places = SplineLattice(
            Mirrored(self._grid, window, self._times, False), sorting.tasks, p.position, size
        )
        self.redistribution.redistribute(self, self.time)
        del self.nodes, self.places, self._window, self._tasks
        self.shear = self.time = 0.0
        return True

    # --- For the redistribution

    def shear_rate(self) -> np.ndarray:
        return shear_rate(self._particles.velocity_gradient)

    def cells(self) -> BoxCells:
        p, block = self._particles, Mirrored(self._grid, self._window, 1, True)
        return BoxCells(block, self._tasks, p.position, p.half_size, np.ascontiguousarray(self._sizes()))

    def scale_volume_ratio(self, factor: np.ndarray) -> None:
        p = self._particles
        for group in p.groups:
            if group.law.uses_equation_of_state:
                p.volume_ratio[group.part] *= factor[group.part]
        np.multiply(p.initial_volume, p.volume_ratio, out=p.volume)

    def shift(self, displacement: np.ndarray) -> None:
        p, grid = self._particles, self._grid
        before = p.position.copy()
        for group in p.groups:
            if group.law.uses_equation_of_state:
                p.position[group.part] += displacement[group.part]
        walls = (grid.faces != OPEN) & (grid.faces != PERIODIC)
        margin = AT_A_WALL * grid.cell_size
        low = np.where(walls[:, 0], margin, -np.inf)
        high = np.where(walls[:, 1], grid.extent - margin, np.inf)
        # Only a particle that a shift moved is kept from a wall: others stay where they are, to the bit.
        moved = (p.position != before).any(axis=1)
        p.position[moved] = np.clip(p.position[moved], low, high)
        if p.affine.shape[1]:
            change = np.einsum("pij,pj->pi", p.affine, p.position - before)
            for axis in range(grid.dim):
                along = np.ascontiguousarray(change[:, axis])
                # What a node gains is taken from all around it: not one bit of momentum is made.
                taken = self.nodes.at_particles(self.nodes.average(along, p.mass))
                p.velocity[:, axis] += along - taken

    def weigh(self, factor: np.ndarray) -> None:
        self._particles.quadrature[:] = factor
