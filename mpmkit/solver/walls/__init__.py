"""Walls that stand anywhere and move: where they meet the grid, and what they do to its nodes."""

from .faces import Faces
from .walls import Room, Walls

__all__ = ["Faces", "Room", "Walls"]
