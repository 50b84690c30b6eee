"""Signed distances: how far points are from a solid, and in which direction."""

from .ball import Ball
from .brick import Brick, BrickShell
from .revolved import Revolved
from .section import Section, trapezium, trapezium_shell
from .solid import HalfSpace, Inverted, Shell, Solid

__all__ = [
    "Ball",
    "Brick",
    "BrickShell",
    "HalfSpace",
    "Inverted",
    "Revolved",
    "Section",
    "Shell",
    "Solid",
    "trapezium",
    "trapezium_shell",
]
