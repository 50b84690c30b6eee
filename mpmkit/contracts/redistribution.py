"""Contract of a redistribution: it keeps volume, box and position of the particles consistent."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar, Protocol

import numpy as np

from .base import Plugin


class Lattice(Protocol):
    """Evenly spaced nodes over the material with quadratic B-splines, mirrored at walls.

    Arrays of nodes have the shape ``(nodes,)``, arrays of particles ``(n,)`` or ``(n, dim)``.
    """

    spacing: float
    """m"""

    def crowding(self) -> np.ndarray:
        """κ_n = Σ size_p N_np / room_n: 1 inside the material, less at its surface."""

    def average(self, values: np.ndarray) -> np.ndarray:
        """Σ size_p N_np f_p / Σ size_p N_np of a particle field; zero where there is no material."""

    def at_particles(self, nodal: np.ndarray) -> np.ndarray:
        """Σ N_np f_n, ``(n,)``."""

    def slope_at_particles(self, nodal: np.ndarray) -> np.ndarray:
        """Σ ∇N_np f_n, ``(n, dim)``, 1/m."""

    def least_around(self, nodal: np.ndarray) -> np.ndarray:
        """Smallest value of a node and all its neighbours, corners included; nodes that are not stored have
        the value 0.
        """

    def nearest(self, other: Lattice, nodal: np.ndarray) -> np.ndarray:
        """Values of the nodes of another lattice at the nodes of this one, each from the nearest."""


class Cells(Protocol):
    """The cells of the grid, and the part of each particle's box in them."""

    def filling(self, weights: np.ndarray | None = None) -> np.ndarray:
        """Q_c = Σ w_p size_p part_pc / size of the cell, ``(cells,)``; default of w_p: 1."""

    def least_beside(self, filling: np.ndarray) -> np.ndarray:
        """Smallest value of a cell and of the cells that share a face with it."""

    def at_particles(self, values: np.ndarray) -> np.ndarray:
        """Σ part_pc f_c, ``(n,)``."""


class Redistributing(Protocol):
    """Access of a redistribution to the scene.

    Sizes are areas V / (2 π r) in axisymmetric scenes, else volumes.
    """

    nodes: Lattice
    """The nodes of the grid."""
    places: Lattice
    """A lattice with the spacing of the particles."""

    @property
    def time(self) -> float:
        """Time at the start of the step, s."""

    def cells(self) -> Cells:
        """The cells of the grid, with the present boxes."""

    def shear_rate(self) -> np.ndarray:
        """γ̇ = √(2 D':D') of each particle, 1/s, ``(n,)``, and at most twice the largest mean since the last
        redistribution: if a flow starts suddenly, the present rate is not the rate of that whole time.
        """

    def random(self) -> np.ndarray:
        """Random numbers from -1 to 1, ``(n, dim)``, the same at every call in a step.

        They depend only on the number of the particle, the axis and the time. So a run gives the same result
        with any number of threads, and when it is resumed.
        """

    def scale_volume_ratio(self, factor: np.ndarray) -> None:
        """J ← factor J, for fluids only, at once: the pressure jumps by ρ c² (1 - factor)."""

    def expand(self, strain: np.ndarray) -> None:
        """ln J ← ln J + strain, for fluids only.

        The strain is applied gradually, in proportion to the shear that follows, over the same shear as since
        the last redistribution. The next call replaces the part that is not applied yet.
        """

    def shift(self, displacement: np.ndarray) -> None:
        """x ← x + δx, for fluids only, not beyond walls, and no box across the axis of an axisymmetric scene.

        v changes by its affine part; Σ m v is kept.
        """

    def weigh(self, factor: np.ndarray) -> None:
        """Factors of the volumes of the particles in the internal force from now on."""


class Redistribution(Plugin):
    """Keeps volume, box and position of the particles consistent in long shear."""

    equal_boxes: ClassVar[bool] = False
    """Whether boxes have equal sides and hold the volume. Otherwise they follow the normal strain, and J is
    drawn to its average as the volumetric treatment asks."""

    def is_due(self, shear: float) -> bool:
        """Whether a redistribution is due, given the largest ∫ γ̇ dt, 1, since the last one."""
        return False

    @abstractmethod
    def redistribute(self, ops: Redistributing, time: float) -> None:
        """Redistribute for the ``time``, s, since the last redistribution."""
