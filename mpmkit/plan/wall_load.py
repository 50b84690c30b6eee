"""The load of walls in a step, measured by the nodes near them."""

from __future__ import annotations

from ..solver.simulation import Simulation

TOUCHED = 500.0
"""Fixed cost of a wall that material touches, in nodes near it (docs/performance.md)."""
IDLE = 60.0
"""The same for a wall that no material touches; only its position is computed."""


def load(simulation: Simulation, wider: float = 1.0) -> float:
    """Load of the walls in the present step, in nodes; 0 without walls.

    Args:
        simulation: a scene after a step.
        wider: ratio of its cells to those of the run that it represents; that run has more nodes near a
        surface.
    """
    more = wider ** (simulation.grid.dim - 1)
    return sum(
        IDLE + (TOUCHED + more * len(wall.near.at) if wall.touches else 0.0)
        for wall in simulation.operations.walls.walls
    )
