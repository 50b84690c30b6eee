"""Contract of a shape function: separable 1-D weights on a regular grid."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar

import numpy as np

from .base import Plugin

MOST_NODES = 4
"""Nodes along an axis that a shape function may touch at most: those within a cell of the particle's own."""


class ShapeFunction(Plugin):
    """How a particle is spread over the nodes around it.

    Node ``base + a`` of an axis, ``0 <= a < support``, lies at ``(base + a) * cell_size`` from the grid's
    origin; the weight of a node in space is the product of its weights along the axes.
    """

    support: ClassVar[int]
    """Nodes that a particle touches along each axis, 2 to 4: ``base`` is its own cell or the one before."""

    smooth: ClassVar[bool] = True
    """Whether the gradients of the weights are continuous as a particle moves from cell to cell."""

    @property
    def particle_domain(self) -> str:
        """How half-sizes follow the deformation: ``strain`` (normal strain along each axis), ``fixed``,
        ``stretch`` (U_ii) or ``volume`` (J^(1/dim))."""
        return "fixed"

    @abstractmethod
    def fill(
        self,
        position: np.ndarray,
        half_size: np.ndarray,
        cell_size: float,
        base: np.ndarray,
        weight: np.ndarray,
        gradient: np.ndarray,
    ) -> None:
        """Fill the 1-D tables of all particles, in place.

        Args:
            position: ``(n, dim)``, from the grid's origin, m.
            half_size: ``(n, dim)`` half side lengths l_p of the particle domains, m.
            cell_size: distance between nodes, m.
            base: ``(n, dim)`` int32, first node touched along each axis (out).
            weight: ``(n, dim, support)`` weights, 1 (out).
            gradient: ``(n, dim, support)`` derivatives of the weights along their axis, 1/m (out).
        """

    @abstractmethod
    def fill_radial(
        self,
        radius: np.ndarray,
        half_size: np.ndarray,
        cell_size: float,
        base: np.ndarray,
        weight: np.ndarray,
        gradient: np.ndarray,
        hoop: np.ndarray,
    ) -> None:
        """Fill the tables of the radial axis of an axisymmetric scene; the axis of symmetry is at radius 0.

        The weights are averages over the particle domain weighted with r, and ``hoop`` is the average of
        ``N / r`` (Nairn & Guilkey 2015), so that a field u_r = e r has D_rr = D_θθ = e exactly.

        Args:
            radius: ``(n,)``, m.
            half_size: ``(n,)`` radial half-sizes, m.
            cell_size: distance between nodes, m.
            base: ``(n,)`` int32 (out).
            weight: ``(n, support)``, 1 (out).
            gradient: ``(n, support)``, 1/m (out).
            hoop: ``(n, support)``, 1/m (out).
        """
