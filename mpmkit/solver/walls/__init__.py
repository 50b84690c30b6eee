"""Walls at any position, also moving: their nodes on the grid, and their action on these nodes."""

from .faces import Faces
from .walls import Room, Walls

__all__ = ["Faces", "Room", "Walls"]
