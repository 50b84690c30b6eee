"""Walls of a scene: where they meet the grid, what they do to its nodes, and what that takes."""

from .wall import Wall
from .walls import Walls

__all__ = ["Wall", "Walls"]
