"""The named operations of one step, with which orders and velocity updates are written."""

from __future__ import annotations

from typing import Literal, Protocol

import numpy as np

Weighting = Literal["mass", "volume"]
"""What particles weigh in an average: their mass, or their volume."""


class Operations(Protocol):
    """Operations on all particles and all nodes of a scene.

    Shape functions are evaluated once, at the positions of the start of the step, and every operation of
    the step uses them.
    """

    cell_size: float
    """m, side of a cell."""

    @property
    def time(self) -> float:
        """Time at the start of the step, s."""

    acoustic_time: float
    """s, a cell over the fastest wave: how long a sound takes to be seen by the next node."""
    mean_speed: float
    """m/s, root mean square of the particles' velocity, weighted with mass, a few steps ago at most."""

    def map_to_grid(self, *, forces: bool = True) -> None:
        """Particles to nodes: mass, momentum and, if asked, the body forces and the internal force."""

    def map_forces(self) -> None:
        """Particles to nodes: the body forces and the internal force of the present stress alone.

        Adds to what is there: once a step, after ``map_to_grid(forces=False)``.
        """

    def solve_momentum(self, dt: float) -> None:
        """Update the nodal velocity, v ← v + dt f / m, with the conditions on the faces."""

    def map_to_particles(self, dt: float, *, velocity_gradient: bool = False) -> None:
        """Nodes to particles: velocity, by the velocity update, and position.

        With ``velocity_gradient``, as ``update_velocity_gradient`` at the same time, in one pass.
        """

    def remap_velocity(self) -> None:
        """Replace the nodal velocity by that of the updated particles (MUSL)."""

    def update_velocity_gradient(self) -> None:
        """Nodes to particles: gradient of the present nodal velocity."""

    def update_stress(self, dt: float) -> None:
        """Deformation, volume ratio, pressure and stress of every particle."""

    def move_particles(self, dt: float, *, flip: float, affine: bool = False) -> None:
        """x ← x + dt ṽ and v ← flip (v + Δṽ) + (1 - flip) ṽ, with ṽ the new nodal velocity at the particle
        and Δṽ what the step changed in it. Used by velocity updates.

        With ``affine``, also the affine part of the nodal velocity, C = Σ N v (x_node - x̄)ᵀ D⁻¹ with the
        diagonal D = Σ N (x_node - x̄)²; for velocity updates that say ``affine = True``.
        """

    def average(self, values: np.ndarray, weighting: Weighting = "volume") -> np.ndarray:
        """Average of a particle field over the grid, ``(n,)``: to the nodes and back to the particles."""

    def particles_to_nodes(self, values: np.ndarray, weighting: Weighting = "volume") -> np.ndarray:
        """Average of a particle field around each node, Σ w N f / Σ w N: ``(n,)`` to nodes.

        The weight w is the mass or the volume. Particles whose law computes its own pressure are left out of
        averages by volume.
        """

    def nodes_to_particles(self, nodal: np.ndarray) -> np.ndarray:
        """Interpolate a nodal field at the particles."""
