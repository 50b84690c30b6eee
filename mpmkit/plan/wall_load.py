"""What walls have to do in a step, by the nodes near them."""

from __future__ import annotations

from ..solver.simulation import Simulation

TOUCHED = 500.0
"""Nodes near a wall that cost as much as the wall itself, where material touches it (docs/performance.md)."""
IDLE = 60.0
"""The same of a wall that nothing touches, which has only to be where it is."""


def load(simulation: Simulation, wider: float = 1.0) -> float:
    """What the walls have to do in the present step, in nodes; 0 without walls.

    Args:
        simulation: a scene after a step.
        wider: how many times wider its cells are than those of the run that it stands for, which has so many
            more nodes near a surface.
    """
    more = wider ** (simulation.grid.dim - 1)
    return sum(
        IDLE + (TOUCHED + more * len(wall.near.at) if wall.touches else 0.0)
        for wall in simulation.operations.walls.walls
    )
